/* SPDX-License-Identifier: MIT
 *
 * echo: what the generated servants include.
 */
#ifndef ECHO_H
#define ECHO_H

#include "Random.h"

#endif
