/* SPDX-License-Identifier: MIT
 *
 * clock_step: a library that a program preloads. Every second it makes the time of day that the
 * program reads jump by one to three hours, forward or back. A program that uses the time of day to
 * wait or to measure then fails.
 */

#define _GNU_SOURCE
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>

static void step(time_t* seconds) {
    static const int steps[] = {0, 3600, -3600, 7200};
    *seconds += steps[*seconds & 3];
}

int clock_gettime(clockid_t clock, struct timespec* now) {
    const int status = (int)syscall(SYS_clock_gettime, clock, now);
    if (status == 0 && clock == CLOCK_REALTIME)
        step(&now->tv_sec);
    return status;
}

int gettimeofday(struct timeval* now, void* zone) {
    struct timespec precise;
    (void)zone;
    clock_gettime(CLOCK_REALTIME, &precise);
    now->tv_sec = precise.tv_sec;
    now->tv_usec = precise.tv_nsec / 1000;
    return 0;
}

time_t time(time_t* result) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    if (result)
        *result = now.tv_sec;
    return now.tv_sec;
}
