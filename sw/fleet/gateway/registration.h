// SPDX-License-Identifier: MIT
//
// registration: one vehicle's entry in IceGrid's registry, and the object adapter to which the
// entry refers. Both exist while this ground station serves the vehicle.
//
// Among the ground stations that are connected to a vehicle, the one that connected last serves it.
// The others close their adapters. One of them takes over when the station in the registry no
// longer listens.

#pragma once

#include "forwarder.h"

#include <Ice/Ice.h>
#include <functional>

namespace gateway {

// Events publishes the events of a vehicle to an IceStorm topic, as calls of Station.vehicleState.
class Events {
public:
    // `publisher` is the publisher of the topic; null disables events.
    Events(std::string vehicle, std::shared_ptr<Ice::ObjectPrx> publisher)
        : vehicle_(std::move(vehicle)), publisher_(std::move(publisher)) {}
    // publishes the vehicle's proxy, or a null proxy if the vehicle is not connected
    void tell(bool isHere) const;
    // Publishes a call of the vehicle. In a call of vehicleState, replaces the vehicle's proxy by a
    // proxy with which clients reach the vehicle.
    void pass(const Request& request, Response onResponse, Failure onError) const;

private:
    const std::string vehicle_;
    const std::shared_ptr<Ice::ObjectPrx> publisher_;
};

// In the parameters of a call of Station.vehicleState, replaces the vehicle's proxy by the result
// of `reached`: a proxy with which clients reach the vehicle. A null proxy stays null.
void replaceVehicle(
    Request& call, const std::shared_ptr<Ice::Communicator>& ic,
    const std::function<std::shared_ptr<Ice::ObjectPrx>(const std::shared_ptr<Ice::ObjectPrx>&)>&
        reached);

class Registration {
public:
    using Open = std::function<std::shared_ptr<Ice::ObjectAdapter>()>;
    // `open` creates the adapter and leaves it inactive. `locator` is null if no registry is
    // configured; look() and leave() must then not be called.
    Registration(std::string name, Forwarder& forwarder, const Events& events, Open open,
                 const std::shared_ptr<Ice::LocatorPrx>& locator)
        : open(std::move(open)), name_(std::move(name)), forwarder_(forwarder), events_(events),
          locator_(locator ? locator->ice_invocationTimeout(patienceMs) : nullptr) {}
    // Checks whether the vehicle is connected, and which ground station the registry contains. Must
    // be called every `lookMs`. Throws an Ice exception if no registry answers.
    void look();
    void leave(); // must be called before the program ends

    static constexpr int lookMs = 250, looksBetweenQuestions = 4;
    // time-out for the registry and for other ground stations, ms
    static constexpr int patienceMs = 2000;
    const Open open;

private:
    std::shared_ptr<Ice::ObjectPrx> find() const;
    void enter(const std::shared_ptr<Ice::ObjectPrx>& proxy) const;
    bool isOwn(const std::shared_ptr<Ice::ObjectPrx>& found) const;
    void come();
    void close();

    const std::string name_;
    Forwarder& forwarder_;
    const Events& events_;
    const std::shared_ptr<Ice::LocatorPrx> locator_;
    std::shared_ptr<Ice::ObjectAdapter> adapter_, closing_;
    std::shared_ptr<Ice::ObjectPrx> own_; // proxy with the endpoints of the adapter
    // value of session() when this ground station last wrote to the registry
    unsigned entered_ = 0;
    // true if this ground station has entered itself into the registry
    bool isEntered_ = false;
    int looks_ = 0;
};

} // namespace gateway
