// SPDX-License-Identifier: MIT
//
// registration: one vehicle's entry in IceGrid's registry, and the object adapter that it refers
// to. Both exist while this ground station holds the vehicle.
//
// A ground station holds a vehicle while it has a connection to it. The registry contains the
// ground station that connected last; another one that still receives the vehicle stands by.

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
    void tell(bool isHere) const; // publishes the vehicle's proxy, or a null proxy; no parameters
    // Publishes a call of the vehicle. The proxy in a vehicleState leads clients to the vehicle.
    void pass(const Request& request, Response onResponse, Failure onError) const;

private:
    const std::string vehicle_;
    const std::shared_ptr<Ice::ObjectPrx> publisher_;
};

// Replaces the vehicle's proxy in a call of Station.vehicleState by `reached`, with which clients
// reach the vehicle; a null proxy is kept.
void replaceVehicle(
    Request& call, const std::shared_ptr<Ice::Communicator>& ic,
    const std::function<std::shared_ptr<Ice::ObjectPrx>(const std::shared_ptr<Ice::ObjectPrx>&)>&
        reached);

class Registration {
public:
    using Open = std::function<std::shared_ptr<Ice::ObjectAdapter>()>;
    // `open` creates the adapter, not yet active. `locator`: null without a registry; then look()
    // and leave() are never called.
    Registration(std::string name, Forwarder& forwarder, const Events& events, Open open,
                 const std::shared_ptr<Ice::LocatorPrx>& locator)
        : open(std::move(open)), name_(std::move(name)), forwarder_(forwarder), events_(events),
          locator_(locator ? locator->ice_invocationTimeout(patienceMs) : nullptr) {}
    // Checks whether the vehicle is connected, and which ground station is registered. Must be
    // called every `lookMs`. Throws Ice's exceptions if no registry answers.
    void look();
    void leave(); // must be called before the program ends

    static constexpr int lookMs = 250, looksBetweenQuestions = 4;
    static constexpr int patienceMs = 2000; // time-out of a registry or another ground station
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
    unsigned entered_ = 0;                // value of session() when the registry was last written
    bool isEntered_ = false;              // this ground station has registered itself
    int looks_ = 0;
};

} // namespace gateway
