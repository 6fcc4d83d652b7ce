/* SPDX-License-Identifier: MIT
 *
 * link_handshake_clear: the handshake without a key.
 */
#pragma once

#include "link_handshake.h"

/* Rules of the handshake without a key: any peer may start a session; a frame of an unknown session
 * is answered with RST. */
extern const Link_HandshakeRules link_clearHandshake;
