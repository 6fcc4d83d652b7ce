/* SPDX-License-Identifier: MIT
 *
 * link_handshake: agrees with the peer on the identity of a session: nonces, features, keys. It
 * holds the state of the link and the identities of the present session and the next one. It takes
 * and sends frames of the handshake, and returns what follows for the session (Link_Verdict).
 */
#pragma once

#include "link_pacing.h"

/* Consequences of a frame of the handshake: a set of bits. */
typedef enum Link_Verdict {
    LINK_VERDICT_NONE = 0,
    LINK_VERDICT_BEGIN = 1,       /* the session of the candidate begins */
    LINK_VERDICT_UNCONFIRMED = 2, /* the peer may not know that session yet */
    LINK_VERDICT_ACK = 4,         /* an acknowledgement should be sent */
    LINK_VERDICT_LOST = 8         /* the peer does not know the current session */
} Link_Verdict;

struct Link_Handshake;

/* Rules of a handshake, without or under a key. */
typedef struct Link_HandshakeRules {
    /* Returns the cost of trying to open a frame, rounds of Ascon; 0 if the frame is not for this
     * side at this time. */
    U32 (*cost)(const struct Link_Handshake* handshake, const U8* frame);
    /* Fills in the seal that a frame has if it is genuine. `attempt`: 0 or 1. Returns 0 if there is
     * no such seal. Without a key this includes other frames of the candidate's session. */
    int (*expect)(struct Link_Handshake* handshake, const U8* frame, U32 attempt, Link_Seal* seal);
    /* Acts upon an opened frame of the handshake; `attempt` opened it. Returns a set of
     * Link_Verdict. */
    U32 (*onFrame)(struct Link_Handshake* handshake, const U8* frame, U32 attempt);
    /* Sends HELLO; or answers `unknown`, a frame of an unknown session. */
    void (*sendHello)(struct Link_Handshake* handshake, const U8* unknown);
} Link_HandshakeRules;

typedef struct Link_Handshake {
    Link_Pacing* pacing;
    const Link_HandshakeRules* rules;
    U8 state;                   /* Link_State */
    U8 hasCandidate;            /* 1, without a key: a HELLO was answered by the candidate */
    U8 keys;                    /* set of slots with a key */
    U8 slot;                    /* slot of the newest HELLO's key */
    U8 isGround;                /* 1: this side is the ground, under a key */
    U8 isAnswered;              /* 1: a HELLO was answered with `nonce` */
    U8 isUnconfirmed;           /* 1: the peer may not know of the session yet */
    U8 hasPair;                 /* 1: `pair` is made */
    U32 firstAnswer;            /* time of the first answer with `nonce`, us */
    U32 lastAnswer;             /* time of the newest answer, us */
    U32 helloAt;                /* time of the next HELLO or CONFIRM, us */
    U32 helloEvery;             /* interval to the one after it, us */
    U32 resetAt;                /* time of the newest answer to an unknown session, us */
    U8 nonce[LINK_NONCE_BYTES]; /* own nonce of the next session */
    Link_Identity present;
    Link_Identity candidate; /* next session, until the peer has confirmed it */
    Link_Secret secrets[LINK_KEYS];
    Link_KeyPair pair; /* pair of the next session */
} Link_Handshake;

/* Sets the rules. */
void link_useRules(Link_Handshake* handshake, const Link_HandshakeRules* rules);

/* Sets a slot's key, and this side's role and vehicle; `key` 0 wipes the slot. */
void link_setSecret(Link_Handshake* handshake, int slot, const U8* key, U32 side);

/* Draws the nonce of the next session. */
void link_drawNonce(Link_Handshake* handshake);

/* Prepares the candidate from the peer's nonce and the nonce of this side. */
void link_makeCandidate(Link_Handshake* handshake, const U8* peerNonce, U32 features);

/* Sends a frame with both nonces of a session; `of` 0: HELLO with the nonce for the next
 * session. */
void link_sendHandshake(Link_Handshake* handshake, const Link_Identity* of, Link_Kind kind,
                        U32 version);

/* Makes the candidate the present session. */
void link_adoptCandidate(Link_Handshake* handshake, int isUnconfirmed);

/* Wipes the keys of the candidate. */
void link_wipeCandidate(Link_Handshake* handshake);

/* Leaves the present session, wipes its keys, and draws a new nonce. */
void link_leave(Link_Handshake* handshake, Link_State next);

/* Notes a frame of the present session, which confirms it. */
#define LINK_NOTE_CONFIRMED(handshake) ((handshake)->isUnconfirmed = 0)

/* Drops the candidate. Frames that are still on the way from the peer are not answered. */
void link_forgetPeer(Link_Handshake* handshake);

/* Answers a frame of an unknown session, but not too often. */
void link_onUnknown(Link_Handshake* handshake, const U8* frame);

/* Sends HELLO or CONFIRM if it is due, and replaces an old nonce. */
void link_pollHandshake(Link_Handshake* handshake);
