/* SPDX-License-Identifier: MIT
 *
 * uav_tasks: priorities of the vehicle's tasks, and the number of its servants.
 */
#pragma once

#define PRIO_MUTEX 3U
#define PRIO_RADIO 5U
#define PRIO_SERVER 10U
#define PRIO_CORES 11U
#define PRIO_CLIENT 12U
#define PRIO_UPDATE 40U

/* Number of servants that are not servants of cores: chip, uav, update, fpga, keys.
 * cmake/cores.cmake reads this number. */
#define UAV_SERVANTS 5
