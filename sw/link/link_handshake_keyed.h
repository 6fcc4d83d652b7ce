/* SPDX-License-Identifier: MIT
 *
 * link_handshake_keyed: the handshake of links with a key.
 */
#pragma once

#include "link_handshake.h"

/* Rules of the handshake with a key: only a peer that has the key, and that answers now, can start
 * a session. */
extern const Link_HandshakeRules link_keyedHandshake;
