// SPDX-License-Identifier: MIT
//
// camera_never_alone: a CameraAlone for chips without a camera, and for netlists.

#include "camera_alone.h"

struct CameraAlone::Parts {};

CameraAlone::CameraAlone(VSoc&) {}
CameraAlone::~CameraAlone() = default;

bool CameraAlone::exists() const {
    return false;
}

std::vector<std::string> CameraAlone::missing() {
    return {};
}

void CameraAlone::load() {}

bool CameraAlone::follows() {
    return false;
}

bool CameraAlone::clock(McbModel&) {
    return false;
}

void CameraAlone::mark() {}
void CameraAlone::store() {}

uint64_t CameraAlone::storeMarked() {
    return 0;
}

void CameraAlone::repeat(uint64_t) {}
