/* SPDX-License-Identifier: MIT
 *
 * uav_backup: reads and writes the words of the memory that keeps its contents without power.
 * backup.h defines their places.
 */
#include "uav_backup.h"

static const UAV_Board* board;
static void* boardContext;

void UAV_useBoard(const UAV_Board* ours, void* context) {
    board = ours;
    boardContext = context;
}

U32 UAV_random(void* unused) {
    (void)unused;
    return board->random(boardContext);
}

U32 UAV_load(U32 word) {
    return board->load(boardContext, word);
}

void UAV_store(U32 word, U32 value) {
    board->store(boardContext, word, value);
}

U32 UAV_address(void) {
    return UAV_load(BACKUP_AT(vehicle.address));
}

int UAV_isFlying(void) {
    return UAV_load(BACKUP_AT(vehicle.flight)) == BACKUP_FLYING;
}

void UAV_setFlying(int isFlying) {
    UAV_store(BACKUP_AT(vehicle.flight), isFlying ? BACKUP_FLYING : 0);
}
