/* SPDX-License-Identifier: MIT
 *
 * link_handshake_clear: the handshake without a key.
 */
#pragma once

#include "link_handshake.h"

/* Any peer may make a session; an unknown session is answered with RST. */
extern const Link_HandshakeRules link_clearHandshake;
