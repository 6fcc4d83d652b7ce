// SPDX-License-Identifier: MIT
//
// registration: one vehicle's entry in IceGrid's registry, and the object adapter that it leads to.
// Both exist while this ground has the vehicle.
//
// A ground has a vehicle once a connection to it stands, and loses it with the link's session. The
// ground that got it last is in the registry; another that still hears it stands by.

#pragma once

#include "forwarder.h"

#include <Ice/Ice.h>
#include <functional>

namespace gateway {

// Events tells an IceStorm topic what happens to a vehicle, as calls of Station.vehicleState.
class Events {
public:
    // `publisher`: of the topic; null: nobody is told.
    Events(std::string vehicle, std::shared_ptr<Ice::ObjectPrx> publisher)
        : vehicle_(std::move(vehicle)), publisher_(std::move(publisher)) {}
    void tell(bool isHere) const; // the vehicle "uav" by its name, or none; without parameters
    // Passes a call of the vehicle on. A vehicleState names it as clients reach it.
    void pass(const Request& request, Response onResponse, Failure onError) const;

private:
    const std::string vehicle_;
    const std::shared_ptr<Ice::ObjectPrx> publisher_;
};

class Registration {
public:
    using Open = std::function<std::shared_ptr<Ice::ObjectAdapter>()>;
    // `open` makes the adapter, which is not yet active. `locator`: null where there is no
    // registry; then nothing else is called.
    Registration(std::string name, Forwarder& forwarder, const Events& events, Open open,
                 const std::shared_ptr<Ice::LocatorPrx>& locator)
        : open(std::move(open)), name_(std::move(name)), forwarder_(forwarder), events_(events),
          locator_(locator ? locator->ice_invocationTimeout(patienceMs) : nullptr) {}
    // Looks whether the vehicle is here, and who is in the registry; the caller calls it each
    // `lookMs`. Throws Ice's exceptions where no registry answers.
    void look();
    void leave(); // the program ends

    static constexpr int lookMs = 250, looksBetweenQuestions = 4;
    static constexpr int patienceMs = 2000; // with a registry, or another ground
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
    std::shared_ptr<Ice::ObjectPrx> own_; // the adapter's endpoints
    unsigned entered_ = 0;                // the connection that the registry has been told of
    bool isEntered_ = false;              // this ground is in the registry, as far as it knows
    int looks_ = 0;
};

} // namespace gateway
