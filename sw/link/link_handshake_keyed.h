/* SPDX-License-Identifier: MIT
 *
 * link_handshake_keyed: the handshake under a key.
 */
#pragma once

#include "link_handshake.h"

/* Only a peer that has the key, and lives now, makes a session. */
extern const Link_HandshakeRules link_keyedHandshake;
