// SPDX-License-Identifier: MIT
//
// registration: registers and withdraws a vehicle by what the forwarder and the registry say.

#include "registration.h"

#include <iostream>

namespace gateway {

namespace {

constexpr int patienceMs = 2000;               // with a registry, or another ground
constexpr std::chrono::milliseconds late{500}; // of a call under way to a vehicle that has moved

// Returns whether nobody listens at the endpoints of a proxy.
bool isDead(const std::shared_ptr<Ice::ObjectPrx>& proxy) {
    try {
        proxy->ice_invocationTimeout(patienceMs)->ice_getConnection();
    } catch (const Ice::ConnectFailedException&) {
        return true;
    } catch (const Ice::Exception&) {
    }
    return false;
}

} // namespace

// ---- events ----

std::shared_ptr<Ice::ObjectPrx>
Events::byName(const std::shared_ptr<Ice::ObjectPrx>& object) const {
    return object ? object->ice_adapterId(vehicle_) : nullptr;
}

void Events::tell(const std::shared_ptr<Ice::ObjectPrx>& vehicle) const {
    if (!publisher_)
        return;
    Ice::OutputStream out(publisher_->ice_getCommunicator());
    out.startEncapsulation();
    out.write(vehicle);
    out.writeSize(0);
    out.endEncapsulation();
    const auto in = out.finished();
    const auto ignored = [](std::exception_ptr) {}; // the next event tells
    publisher_->ice_invokeAsync("vehicleState", Ice::OperationMode::Normal, in, nullptr, ignored,
                                nullptr, {{"vehicle", vehicle_}});
}

void Events::came() const {
    if (publisher_)
        tell(publisher_->ice_getCommunicator()->stringToProxy("uav@" + vehicle_));
}

void Events::went() const {
    tell(nullptr);
}

void Events::pass(const Request& request, Response onResponse, Failure onError) const {
    Request named = request;
    named.current.ctx["vehicle"] = vehicle_;
    named.current.id = publisher_->ice_getIdentity();
    if (request.current.operation == "vehicleState") {
        const auto ic = publisher_->ice_getCommunicator();
        Ice::InputStream in(ic, request.parameters);
        Ice::OutputStream out(ic);
        out.startEncapsulation(in.startEncapsulation(), Ice::FormatType::DefaultFormat);
        std::shared_ptr<Ice::ObjectPrx> vehicle;
        in.read(vehicle);
        out.write(byName(vehicle));
        out.writeBlob(in.i, in.b.end() - in.i);
        out.endEncapsulation();
        out.finished(named.parameters);
    }
    named.sendTo(publisher_, std::move(onResponse), std::move(onError));
}

// ---- the registration ----

std::shared_ptr<Ice::ObjectPrx>
Registration::find(const std::shared_ptr<Ice::LocatorPrx>& locator) const {
    try {
        return locator->ice_invocationTimeout(patienceMs)->findAdapterById(name_);
    } catch (const Ice::AdapterNotFoundException&) {
        return nullptr;
    }
}

void Registration::tell(const std::shared_ptr<Ice::LocatorPrx>& locator,
                        const std::shared_ptr<Ice::ObjectPrx>& proxy) const {
    locator->ice_invocationTimeout(patienceMs)
        ->getRegistry()
        ->ice_invocationTimeout(patienceMs)
        ->setAdapterDirectProxy(name_, proxy);
}

bool Registration::isOwn(const std::shared_ptr<Ice::ObjectPrx>& found) const {
    return found && own_ && found->ice_toString() == own_->ice_toString();
}

// Opens, if it is not open, and writes this ground into the registry.
void Registration::enter(const std::shared_ptr<Ice::LocatorPrx>& locator) {
    const unsigned session = forwarder_.session();
    if (!adapter_) {
        if (closing_)
            closing_->destroy();
        closing_ = nullptr;
        adapter_ = open();
        own_ = adapter_->createDirectProxy({"any", ""});
        adapter_->activate();
    }
    tell(locator, own_);
    entered_ = session;
    isEntered_ = true;
    std::cout << "gateway: " + name_ + " is here, at " + own_->ice_getEndpoints()[0]->toString() +
                     "\n"
              << std::flush;
    events_.came();
}

// Closes: clients ask the registry again. What waits was not sent, and may go elsewhere.
void Registration::close() {
    if (!adapter_)
        return;
    closing_ = adapter_;
    adapter_ = nullptr;
    closing_->deactivate();
    forwarder_.refuseWaiting();
}

void Registration::look(const std::shared_ptr<Ice::LocatorPrx>& locator) {
    forwarder_.hold();
    const unsigned session = forwarder_.session();
    const bool isNew = session && session != entered_;
    if (!adapter_)
        forwarder_.giveUp(late);
    if (!session)
        close();
    if (!isNew && session == entered_ && ++looks_ < looksBetweenQuestions)
        return;
    looks_ = 0;
    if (!session && !isEntered_)
        return;
    const auto found = find(locator);
    if (!session)
        return leave(locator);
    if (isNew || !found || (!adapter_ && isDead(found)))
        return enter(locator);
    if (adapter_ && !isOwn(found)) {
        close();
        leave(locator);
    }
}

// Removes this ground from the registry, unless another one is there by now.
void Registration::leave(const std::shared_ptr<Ice::LocatorPrx>& locator) {
    if (!isEntered_)
        return;
    const bool isGone = isOwn(find(locator));
    if (isGone)
        tell(locator, nullptr);
    isEntered_ = false;
    std::cout << "gateway: " + name_ + (isGone ? " has left\n" : " is elsewhere\n") << std::flush;
    if (isGone)
        events_.went();
}

} // namespace gateway
