// SPDX-License-Identifier: MIT
//
// registration: enters a vehicle into IceGrid's registry when a session with the vehicle starts,
// and removes the entry when the session ends.

#include "registration.h"

#include <iostream>

namespace gateway {

namespace {

// Time for which calls in progress may still be answered after the vehicle has moved to another
// ground station.
constexpr std::chrono::milliseconds late{500};

// Returns whether no program listens at the endpoints of a proxy.
bool isDead(const std::shared_ptr<Ice::ObjectPrx>& proxy) {
    try {
        proxy->ice_invocationTimeout(Registration::patienceMs)->ice_getConnection();
    } catch (const Ice::ConnectFailedException&) {
        return true;
    } catch (const Ice::Exception&) {
    }
    return false;
}

} // namespace

// ---- events ----

void replaceVehicle(
    Request& call, const std::shared_ptr<Ice::Communicator>& ic,
    const std::function<std::shared_ptr<Ice::ObjectPrx>(const std::shared_ptr<Ice::ObjectPrx>&)>&
        reached) {
    if (call.current.operation != "vehicleState")
        return;
    const std::vector<Ice::Byte> parameters = call.parameters;
    Ice::InputStream in(ic, parameters);
    Ice::OutputStream out(ic);
    out.startEncapsulation(in.startEncapsulation(), Ice::FormatType::DefaultFormat);
    std::shared_ptr<Ice::ObjectPrx> vehicle;
    in.read(vehicle);
    out.write(vehicle ? reached(vehicle) : nullptr);
    out.writeBlob(in.i, in.b.end() - in.i);
    out.endEncapsulation();
    out.finished(call.parameters);
}

void Events::tell(bool isHere) const {
    if (!publisher_)
        return;
    const auto ic = publisher_->ice_getCommunicator();
    Ice::OutputStream out(ic);
    out.startEncapsulation();
    out.write(isHere ? ic->stringToProxy("uav@" + vehicle_) : nullptr);
    out.writeSize(0);
    out.endEncapsulation();
    const auto in = out.finished();
    // errors are ignored, because the next event is published in any case
    const auto ignored = [](std::exception_ptr) {};
    publisher_->ice_invokeAsync("vehicleState", Ice::OperationMode::Normal, in, nullptr, ignored,
                                nullptr, {{"vehicle", vehicle_}});
}

void Events::pass(const Request& request, Response onResponse, Failure onError) const {
    Request named = request;
    named.current.ctx["vehicle"] = vehicle_;
    named.current.id = publisher_->ice_getIdentity();
    replaceVehicle(named, publisher_->ice_getCommunicator(),
                   [this](const auto& vehicle) { return vehicle->ice_adapterId(vehicle_); });
    named.sendTo(publisher_, std::move(onResponse), std::move(onError));
}

// ---- the registration ----

std::shared_ptr<Ice::ObjectPrx> Registration::find() const {
    try {
        return locator_->findAdapterById(name_);
    } catch (const Ice::AdapterNotFoundException&) {
        return nullptr;
    }
}

// Sets the vehicle's endpoints in the registry to the endpoints of a proxy. A null proxy removes
// the entry.
void Registration::enter(const std::shared_ptr<Ice::ObjectPrx>& proxy) const {
    const auto registry = locator_->getRegistry();
    registry->ice_invocationTimeout(patienceMs)->setAdapterDirectProxy(name_, proxy);
}

bool Registration::isOwn(const std::shared_ptr<Ice::ObjectPrx>& found) const {
    return found && own_ && found->ice_toString() == own_->ice_toString();
}

// Opens the adapter if it is closed, and registers this ground station.
void Registration::come() {
    const unsigned session = forwarder_.session();
    if (!adapter_) {
        if (closing_)
            closing_->destroy();
        closing_ = nullptr;
        adapter_ = open();
        own_ = adapter_->createDirectProxy({"any", ""});
        adapter_->activate();
    }
    enter(own_);
    entered_ = session;
    isEntered_ = true;
    std::cout << "gateway: " + name_ + " is here, at " + own_->ice_getEndpoints()[0]->toString() +
                     "\n"
              << std::flush;
    events_.tell(true);
}

// Closes the adapter, so that clients ask the registry again. Calls that still wait here have not
// been sent to the vehicle; clients may send them to another ground station.
void Registration::close() {
    if (!adapter_)
        return;
    closing_ = adapter_;
    adapter_ = nullptr;
    closing_->deactivate();
    forwarder_.refuseWaiting();
}

void Registration::look() {
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
    if (!session)
        return leave();
    const auto found = find();
    if (isNew || !found || (!adapter_ && isDead(found)))
        return come();
    if (adapter_ && !isOwn(found)) {
        close();
        leave();
    }
}

// Removes this ground station's entry from the registry, unless another ground station has replaced
// it.
void Registration::leave() {
    if (!isEntered_)
        return;
    const bool isGone = isOwn(find());
    if (isGone)
        enter(nullptr);
    isEntered_ = false;
    std::cout << "gateway: " + name_ + (isGone ? " has left\n" : " is elsewhere\n") << std::flush;
    if (isGone)
        events_.tell(false);
}

} // namespace gateway
