// SPDX-License-Identifier: MIT
//
// registration: one vehicle's entry in IceGrid's registry, and the object adapter that it leads to.
// Both exist while this ground has the vehicle.
//
// A ground has a vehicle once a connection to it stands, and loses it with the link's session. The
// ground that got it last is in the registry; another that still hears it stands by.

#pragma once
