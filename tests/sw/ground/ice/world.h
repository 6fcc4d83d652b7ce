// SPDX-License-Identifier: MIT
//
// world: stock Ice at both ends of the radio: a client with the plugin, the rig's modems and air,
// and a stock Ice server as the UAV's objects.

#ifndef WORLD_H
#define WORLD_H

#include "Echo.h"
#include "relay.h"
#include <Ice/Ice.h>
#include <set>

class EchoServant : public RadioTest::Uav {
public:
    RadioTest::Bytes repeat(int id, RadioTest::Bytes data, const Ice::Current&) override {
        std::lock_guard<std::mutex> lock(mutex_);
        twice_ += !seen_.insert(id).second;
        return data;
    }
    void note(int id, const Ice::Current&) override {
        std::lock_guard<std::mutex> lock(mutex_);
        twice_ += !seen_.insert(id).second;
        ++noted_;
    }
    void take(int id, RadioTest::Bytes, const Ice::Current& current) override { note(id, current); }
    RadioTest::Bytes fetch(int size, const Ice::Current&) override {
        return RadioTest::Bytes(static_cast<size_t>(size));
    }
    int noted(const Ice::Current&) override {
        std::lock_guard<std::mutex> lock(mutex_);
        return noted_;
    }
    int callBack(int times, const Ice::Current& current) override {
        auto listener = Ice::uncheckedCast<RadioTest::ListenerPrx>(
            current.con->createProxy(Ice::stringToIdentity("listener")));
        return sum(listener, times);
    }
    int callStation(int times, const Ice::Current& current) override {
        return sum(Ice::uncheckedCast<RadioTest::ListenerPrx>(
                       current.adapter->getCommunicator()->stringToProxy(station)),
                   times);
    }
    // Calls that were executed more than once.
    int twice() {
        std::lock_guard<std::mutex> lock(mutex_);
        return twice_;
    }
    std::string station;

private:
    static int sum(const std::shared_ptr<RadioTest::ListenerPrx>& listener, int times) {
        int total = 0;
        for (int i = 0; i < times; ++i)
            total += listener->heard(i);
        return total;
    }
    std::mutex mutex_;
    std::set<int> seen_;
    int noted_ = 0, twice_ = 0;
};

class ListenerServant : public RadioTest::Listener {
public:
    int heard(int number, const Ice::Current&) override { return 2 * number; }
};

class World {
public:
    explicit World(uint64_t seed) : rig(seed) {
        Ice::InitializationData data;
        data.properties = Ice::createProperties();
        data.properties->setProperty("Ice.ThreadPool.Server.Size", "4");
        data.properties->setProperty("Ice.Warn.Connections", "0");
        server_ = Ice::initialize(data);
        uav = server_->createObjectAdapterWithEndpoints("Uav", "tcp -h 127.0.0.1");
        uav->add(echo, Ice::stringToIdentity("echo"));
        uav->activate();
        uavPort = std::dynamic_pointer_cast<Ice::TCPEndpointInfo>(uav->getEndpoints()[0]->getInfo())
                      ->port;
        relay = std::make_unique<Relay>(rig, uavPort);
        echo->station = "station:tcp -h 127.0.0.1 -t 60000 -p " + std::to_string(relay->port());
    }
    ~World() { server_->destroy(); }

    // A program on the ground; several share the serial port's engine.
    Ice::CommunicatorPtr client(std::map<std::string, std::string> more = {}) {
        Ice::InitializationData data;
        data.properties = Ice::createProperties();
        auto set = [&](const std::string& name, const std::string& value) {
            data.properties->setProperty(name, value);
        };
        set("Ice.Plugin.XBeeAT", PLUGIN_FOLDER "/xbeeat:createXBeeAT");
        set("Ice.Default.InvocationTimeout", "60000");
        set("Ice.RetryIntervals", "-1"); // a call is made once, whatever becomes of it
        set("Ice.ThreadPool.Client.Size", "4");
        set("Ice.Warn.Connections", "0");
        set("XBeeAT.Guard", std::to_string(Rig::guardMs));
        set("XBeeAT.Down", "1");
        for (auto& [name, value] : more)
            set(name, value);
        return Ice::initialize(data);
    }
    std::string endpoint() const { return "xbee-at -t 60000 -d " + rig.pty.path(); }
    std::shared_ptr<RadioTest::UavPrx> proxy(const Ice::CommunicatorPtr& ic,
                                             const std::string& connection = "") {
        return Ice::uncheckedCast<RadioTest::UavPrx>(
            ic->stringToProxy("echo:" + endpoint())->ice_connectionId(connection));
    }
    static RadioTest::Bytes pattern(int id, size_t size) {
        RadioTest::Bytes bytes(size);
        for (size_t i = 0; i < size; ++i)
            bytes[i] = static_cast<Ice::Byte>(i * 7 + static_cast<size_t>(id) * 31);
        return bytes;
    }

    Rig rig;
    std::shared_ptr<EchoServant> echo = std::make_shared<EchoServant>();
    std::shared_ptr<Ice::ObjectAdapter> uav;
    int uavPort = 0; // of it
    std::unique_ptr<Relay> relay;

private:
    Ice::CommunicatorPtr server_;
};

#endif
