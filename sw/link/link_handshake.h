/* SPDX-License-Identifier: MIT
 *
 * link_handshake: agrees with the peer on the identity of a session: nonces, features, keys. It
 * holds the state of the link, the identity of the current session, and the identity of the next
 * session (the candidate). It sends and processes handshake frames, and returns the effects of each
 * frame on the session (Link_Verdict).
 */
#pragma once

#include "link_pacing.h"

/* Effects of a handshake frame on the session, one bit each. */
typedef enum Link_Verdict {
    LINK_VERDICT_NONE = 0,
    LINK_VERDICT_BEGIN = 1,       /* the session of the candidate begins */
    LINK_VERDICT_UNCONFIRMED = 2, /* the peer may not know the new session yet */
    LINK_VERDICT_ACK = 4,         /* an acknowledgement should be sent */
    LINK_VERDICT_LOST = 8         /* the peer does not know the current session */
} Link_Verdict;

struct Link_Handshake;

/* Rules of a handshake, with or without a key. */
typedef struct Link_HandshakeRules {
    /* Returns the cost of trying to open a frame, in rounds of Ascon; 0 if this side does not
     * expect such a frame now. */
    U32 (*cost)(const struct Link_Handshake* handshake, const U8* frame);
    /* Writes the seal with which a genuine frame must have been made. Two seals may be possible;
     * `attempt` (0 or 1) selects one. Returns 0 if no such seal exists. Without a key, also
     * writes seals for all other frames of the candidate's session, such as data. */
    int (*expect)(struct Link_Handshake* handshake, const U8* frame, U32 attempt, Link_Seal* seal);
    /* Processes a handshake frame that was opened with the seal of `attempt`. Returns a set of
     * Link_Verdict. */
    U32 (*onFrame)(struct Link_Handshake* handshake, const U8* frame, U32 attempt);
    /* Sends HELLO. If `unknown` is not 0, answers this frame of an unknown session
     * instead. */
    void (*sendHello)(struct Link_Handshake* handshake, const U8* unknown);
} Link_HandshakeRules;

typedef struct Link_Handshake {
    Link_Pacing* pacing;
    const Link_HandshakeRules* rules;
    U8 state; /* Link_State */
    /* only without a key: 1 after a HELLO was answered with the nonce of the candidate */
    U8 hasCandidate;
    U8 keys;          /* set of slots with a key */
    U8 slot;          /* slot of the key used in the newest HELLO */
    U8 isGround;      /* with a key: 1 if this side is the ground station */
    U8 isAnswered;    /* 1: an answer to a HELLO contained `nonce` */
    U8 isUnconfirmed; /* 1: the peer may not know of the session yet */
    U8 hasPair;       /* 1: `pair` has been generated */
    U32 firstAnswer;  /* time of the first answer that contains `nonce`, us */
    U32 lastAnswer;   /* time of the newest answer to a HELLO, us */
    U32 helloAt;      /* time of the next HELLO or CONFIRM, us */
    /* interval between the next HELLO or CONFIRM and the one after it, us */
    U32 helloEvery;
    U32 resetAt;                /* time of the newest answer to a frame of an unknown session, us */
    U8 nonce[LINK_NONCE_BYTES]; /* this side's nonce for the next session */
    Link_Identity present;
    Link_Identity candidate; /* identity of the next session, until the peer has confirmed it */
    Link_Secret secrets[LINK_KEYS];
    Link_KeyPair pair; /* key pair for the next session */
} Link_Handshake;

/* Sets the rules of the handshake. */
void link_useRules(Link_Handshake* handshake, const Link_HandshakeRules* rules);

/* Sets the key of a slot, this side's role, and the vehicle. If `key` is 0, wipes the slot. */
void link_setSecret(Link_Handshake* handshake, int slot, const U8* key, U32 side);

/* Draws a random nonce for the next session. */
void link_drawNonce(Link_Handshake* handshake);

/* Prepares the candidate from the peer's nonce and the nonce of this side. */
void link_makeCandidate(Link_Handshake* handshake, const U8* peerNonce, U32 features);

/* Sends a handshake frame with both nonces of the session `of`. If `of` is 0, sends HELLO with this
 * side's nonce for the next session. */
void link_sendHandshake(Link_Handshake* handshake, const Link_Identity* of, Link_Kind kind,
                        U32 version);

/* Makes the candidate the current session. */
void link_adoptCandidate(Link_Handshake* handshake, int isUnconfirmed);

/* Wipes the keys of the candidate. */
void link_wipeCandidate(Link_Handshake* handshake);

/* Leaves the current session: wipes its keys, draws a new nonce, and sets the state to `next`. */
void link_leave(Link_Handshake* handshake, Link_State next);

/* Records that a frame of the current session arrived, which confirms the session. */
#define LINK_NOTE_CONFIRMED(handshake) ((handshake)->isUnconfirmed = 0)

/* Drops the candidate. For a short time, frames of unknown sessions are not answered, because the
 * peer may have sent them earlier. */
void link_forgetPeer(Link_Handshake* handshake);

/* Answers a frame of an unknown session, unless such a frame was answered a short time ago. */
void link_onUnknown(Link_Handshake* handshake, const U8* frame);

/* Sends HELLO or CONFIRM if it is due, and replaces a nonce that is too old. */
void link_pollHandshake(Link_Handshake* handshake);
