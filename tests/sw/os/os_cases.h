/* SPDX-License-Identifier: MIT
 *
 * os_cases: programs that use uC/OS-II's API, with the output that its manual implies
 * ("MicroC/OS-II, The Real-Time Kernel", chapter 16). They run on the host's port, on the
 * Cortex-M3's, and on request on the real uC/OS-II, with one expected text.
 */
#pragma once

#include "ucos_ii.h"

typedef struct OsCase {
    const char* name;
    void (*prepare)(void);   /* between OSInit and OSStart */
    void (*interrupt)(void); /* its routine, between OSIntEnter and OSIntExit; or 0 */
    unsigned ticks;          /* length of the case */
    const char* expected;    /* the expected output */
} OsCase;

extern const OsCase os_cases[];
extern const unsigned os_caseCount;
extern char os_said[512]; /* by the case that ran last */

void OsCase_begin(void); /* before `prepare`: nothing is said, no stack is used */
/* Makes an interrupt arrive now; implemented by the runner. */
void Runner_interrupt(void);
/* Serves an interrupt that has become possible (a real processor does so at once); implemented by
 * the runner. */
void Runner_passTime(void);
