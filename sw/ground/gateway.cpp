// SPDX-License-Identifier: MIT
//
// gateway: a stock Ice server that passes requests to the vehicle. Ice programs in any language and
// of any version, several at a time, reach the vehicle's objects here, and the vehicle's calls
// reach a server on the ground.
//
// Endpoints, TLS, WebSocket, compression and connections are Ice's; forwarder.h shares the radio.

#include "key_file.h"
#include "registration.h"
#include "rights.h"

#include <CLI/CLI.hpp>
#include <Ice/Ice.h>
#include <IceSSL/IceSSL.h>
#include <IceStorm/IceStorm.h>
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <list>
#include <optional>
#include <regex>
#include <sstream>

extern "C" Ice::Plugin* createXBeeAT(const std::shared_ptr<Ice::Communicator>&, const std::string&,
                                     const Ice::StringSeq&);

namespace {

using namespace gateway;

struct Options {
    std::string device, keyFile, modemKeyFile, rights, station, maintenance, topics;
    std::vector<std::string> vehicles; // NAME=ADDRESS
    std::string listen = "127.0.0.1:10000";
    int baud = 115200, target = 1, source = 0, rfChannel = 0x0C, pan = 0x3332, guardMs = 1000;
    int trace = 0, wait = 30;
    bool setUp = true, isApi = true, isWire = false;
};

// Objects that change keys or programs; only --maintenance opens them.
bool isMaintenance(const Ice::Identity& id) {
    return id.category.empty() && (id.name == "keys" || id.name == "update");
}

// ToVehicle serves the clients' calls: every object of the vehicle.
class ToVehicle : public Ice::BlobjectArrayAsync {
public:
    ToVehicle(Forwarder& forwarder, const Rights& rights, bool allowsMaintenance)
        : forwarder_(forwarder), rights_(rights), allowsMaintenance_(allowsMaintenance) {}
    void ice_invokeAsync(Parameters in, Response response, Failure failed,
                         const Ice::Current& current) override {
        const std::string identity = Ice::identityToString(current.id);
        if (isMaintenance(current.id) && !allowsMaintenance_)
            return refuse(failed, "'" + identity +
                                      "' is for maintenance: it is reached at the endpoint that "
                                      "--maintenance gives");
        const std::string subject = subjectOf(current.con);
        if (!rights_.permit(subject, identity, current.operation))
            return refuse(failed, "'" + subject + "' has no right to call " + current.operation +
                                      " of '" + identity + "'");
        forwarder_.take(
            std::make_shared<Request>(in, std::move(response), std::move(failed), current));
    }

private:
    static void refuse(const Failure& failed, const std::string& why) {
        failed(std::make_exception_ptr(
            Ice::UnknownException(__FILE__, __LINE__, "icesoc-gateway: " + why)));
    }
    Forwarder& forwarder_;
    const Rights& rights_;
    const bool allowsMaintenance_;
};

// ToClients serves the vehicle's calls on the connection of the clients.
class ToClients : public Ice::BlobjectArrayAsync {
public:
    explicit ToClients(Forwarder& forwarder) : forwarder_(forwarder) {}
    void ice_invokeAsync(Parameters in, Response response, Failure failed,
                         const Ice::Current& current) override {
        forwarder_.takeCallback(
            std::make_shared<Request>(in, std::move(response), std::move(failed), current));
    }

private:
    Forwarder& forwarder_;
};

// ToStation serves the vehicle's calls on its own connection.
class ToStation : public Ice::BlobjectArrayAsync {
public:
    // `events`: they go there, not to `station`, if a topic is given.
    ToStation(std::shared_ptr<Ice::ObjectPrx> station, std::string where, const Events* events)
        : station_(std::move(station)), where_(std::move(where)), events_(events) {}
    void ice_invokeAsync(Parameters in, Response response, Failure failed,
                         const Ice::Current& current) override {
        if (events_)
            return events_->pass(Request(in, response, failed, current), response, failed);
        if (!station_)
            throw Ice::ObjectNotExistException(__FILE__, __LINE__, current.id, current.facet,
                                               current.operation);
        const auto complain = [failed, where = where_](std::exception_ptr why) {
            try {
                std::rethrow_exception(why);
            } catch (const Ice::SocketException& e) {
                std::cerr << "gateway: the UAV calls, and nobody listens at " + where + ": " +
                                 e.what() + "\n";
            } catch (...) {
            }
            failed(why);
        };
        Request(in, response, failed, current).sendTo(station_, response, complain);
    }

private:
    const std::shared_ptr<Ice::ObjectPrx> station_;
    const std::string where_;
    const Events* const events_;
};

// Returns Ice's endpoints of "HOST:PORT" or "[::1]:PORT"; other words are endpoints already.
std::string endpointsOf(const std::string& text) {
    if (text.find(' ') != std::string::npos)
        return text;
    const size_t colon = text.rfind(':');
    if (colon == std::string::npos || colon == 0)
        throw std::runtime_error("'" + text + "': give HOST:PORT, or Ice's endpoints");
    const std::string port = text.substr(colon + 1);
    if (port.empty() || port.find_first_not_of("0123456789") != std::string::npos ||
        port.size() > 5 || std::stoul(port) > 65535)
        throw std::runtime_error("'" + text + "': a port is 0 to 65535");
    std::string host = text.substr(0, colon);
    if (host.front() == '[') { // as in URLs: [::1]:10000
        if (host.back() != ']')
            throw std::runtime_error("'" + text + "': a ] is missing");
        host = host.substr(1, host.size() - 2);
    }
    return "tcp -h \"" + host + "\" -p " + port;
}

// Returns the port of an adapter's first endpoint. Throws if one of them lets other machines call
// in the clear.
int checkedPort(const std::shared_ptr<Ice::ObjectAdapter>& adapter) {
    int port = 0;
    for (const auto& endpoint : adapter->getEndpoints()) {
        auto info = endpoint->getInfo();
        const bool isSecure = info->secure();
        while (info->underlying)
            info = info->underlying;
        const auto ip = std::dynamic_pointer_cast<Ice::IPEndpointInfo>(info);
        if (!ip)
            continue;
        port = port ? port : ip->port;
        const bool isHere = ip->host.compare(0, 4, "127.") == 0 || ip->host == "::1" ||
                            ip->host == "0:0:0:0:0:0:0:1" || ip->host == "localhost";
        if (!isSecure && !isHere)
            throw std::runtime_error(
                "'" + endpoint->toString() +
                "' would let every machine of the network call in the clear: listen at 127.0.0.1, "
                "or give an ssl endpoint");
    }
    return port;
}

// Reads the modem's key from a file: every user of the machine can read the command line.
std::string readModemKey(const std::string& path) {
    std::string key = XBeeAT::readSecret(path);
    key.erase(key.find_last_not_of(" \n") + 1);
    if (key.empty() || key.size() > 32 ||
        key.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
        throw std::runtime_error("the modem's AES key in '" + path +
                                 "' must be 1 to 32 hexadecimal digits");
    return key;
}

void setProperties(const std::shared_ptr<Ice::Properties>& p, const Options& o) {
    const auto preset = [&p](const std::string& name, const std::string& value) {
        if (p->getProperty(name).empty())
            p->setProperty(name, value);
    };
    preset("Ice.ThreadPool.Server.Size", "4");
    preset("Ice.ThreadPool.Server.SizeMax", "256"); // each client that waits for room holds one
    preset("Ice.ThreadPool.Server.Serialize", "1");
    preset("Ice.ThreadPool.Client.Size", "4");
    preset("Ice.ACM.Client.Close", "0"); // the vehicle may call back at any time
    preset("Ice.RetryIntervals", "-1");
    preset("Ice.Override.CloseTimeout", "5000");
    preset("Ice.Warn.Connections", "0");
    preset("Ice.Warn.Dispatch", "0");
    preset("XBeeAT.Statistics", "1");
    preset("XBeeAT.Trace", std::to_string(o.trace));
    p->setProperty("XBeeAT.Setup", o.setUp ? "1" : "0");
    p->setProperty("XBeeAT.Api", o.isApi ? "1" : "0");
    p->setProperty("XBeeAT.KeyFile", o.keyFile);
    p->setProperty("Ice.Override.ConnectTimeout", "30000"); // the modem is set up meanwhile
    if (!o.modemKeyFile.empty())
        p->setProperty("XBeeAT.ModemKey", readModemKey(o.modemKeyFile));
    Ice::registerPluginFactory("XBeeAT", createXBeeAT, true);
    if ((o.listen + o.maintenance).find("ssl ") != std::string::npos ||
        (o.listen + o.maintenance).find("wss ") != std::string::npos)
        Ice::registerIceSSL();
}

// Returns the endpoint of the vehicle, and of its calls, at the serial port.
std::string radioEndpoint(const Options& o, int address) {
    std::ostringstream s;
    if (o.isWire)
        s << "serial -d \"" << o.device << "\" -b " << o.baud << " -a " << address << " -s "
          << o.source;
    else
        s << "xbee-at -d \"" << o.device << "\" -b " << o.baud << " -a " << address << " -s "
          << o.source << " -c " << o.rfChannel << " -i " << o.pan << " -g " << o.guardMs;
    s << " -t " << o.wait * 1000;
    return s.str();
}

void addOptions(CLI::App& app, Options& o) {
    app.add_option("-d,--device", o.device, "serial port of the modem")->required();
    app.add_option("-b,--baud", o.baud, "baud rate (115200 is the modem's BD 7)")
        ->check(CLI::IsMember({1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200, 250000}));
    const auto one = app.add_option("-a,--address", o.target, "the UAV's 16-bit address")
                         ->check(CLI::Range(0, 0xFFFF));
    app.add_option("--vehicle", o.vehicles,
                   "NAME=ADDRESS, as uav7=0x0007, for each of several vehicles; their ports follow "
                   "one another in the order of names")
        ->excludes(one);
    app.add_option("-s,--source", o.source, "own 16-bit address")->check(CLI::Range(0, 0xFFFF));
    app.add_option("-c,--channel", o.rfChannel, "RF channel")->check(CLI::Range(0x0B, 0x1A));
    app.add_option("-i,--pan", o.pan, "network id")->check(CLI::Range(0, 0xFFFF));
    app.add_option(
        "--key", o.keyFile,
        "file (mode 0600) with the vehicle's key, 32 hexadecimal digits, or a line "
        "\"0x0001 KEY\" for each vehicle; /dev/fd/3: a descriptor. Without: in the clear");
    app.add_option("--modem-key", o.modemKeyFile,
                   "file (mode 0600) with the modems' AES key, up to 32 hexadecimal digits");
    app.add_option("-g,--guard", o.guardMs, "guard time of the modem as it is, ms")
        ->check(CLI::Range(2, 3300));
    app.add_flag("!--no-setup", o.setUp, "the modem is set up already");
    app.add_flag("!--transparent", o.isApi, "the modem is used in transparent mode, not API mode");
    app.add_flag("--wire", o.isWire,
                 "no modems: the port is wired to the vehicle's board, whose jumper says so");
    app.add_option("-l,--listen", o.listen,
                   "HOST:PORT of this machine for clients, [::1]:PORT too; port 0: any, it is "
                   "printed. Or Ice's endpoints, e.g. \"ssl -p 10001\"");
    const auto station = app.add_option(
        "--station", o.station, "HOST:PORT, or Ice's endpoints, of the server that the UAV calls");
    app.add_option("--topics", o.topics,
                   "proxy of IceStorm's topic manager: the UAVs' calls go to the topic 'vehicles', "
                   "and who comes and goes")
        ->excludes(station);
    app.add_option("--maintenance", o.maintenance,
                   "HOST:PORT, or Ice's endpoints, at which the objects 'keys' and 'update' are "
                   "reached, too. Without: nowhere");
    app.add_option("--rights", o.rights,
                   "JSON file: which certificate may call which identities and operations");
    app.add_option("--wait", o.wait,
                   "seconds that a call waits for the radio, and then for the vehicle to take it; "
                   "then it fails")
        ->check(CLI::Range(1, 3600));
    app.add_option("-t,--trace", o.trace, "0 errors, 1 link and connections, 2 AT commands")
        ->check(CLI::Range(0, 2));
    app.footer("Ice's properties are options, too, e.g. --IceSSL.CertFile=gateway.p12. With "
               "--Ice.Default.Locator\neach vehicle is in IceGrid's registry by its name, uav1 for "
               "address 1, while it is here.");
}

// Returns the vehicles' names and addresses. Throws if they make no sense.
std::map<std::string, int> fleetOf(const Options& o) {
    std::map<std::string, int> fleet;
    for (const std::string& text : o.vehicles) {
        const size_t equals = text.find('=');
        const std::string name = text.substr(0, equals);
        const std::string number = equals < text.size() ? text.substr(equals + 1) : "";
        char* end = nullptr; // a number that is too large for a long becomes the largest one
        const long address = std::strtol(number.c_str(), &end, 0);
        if (name.empty() || number.empty() || !std::isdigit(number[0]) || address > 0xFFFF || *end)
            throw std::runtime_error("'" + text + "': give NAME=ADDRESS, as uav7=0x0007");
        if (!fleet.emplace(name, int(address)).second)
            throw std::runtime_error("'" + name + "' is the name of two vehicles");
    }
    if (fleet.empty())
        fleet["uav" + std::to_string(o.target)] = o.target;
    return fleet;
}

// Returns endpoints whose ports are `place` above the given ones; 0 stays: any.
std::string portsAbove(const std::string& endpoints, int place) {
    static const std::regex port(R"(-p ([1-9]\d*))");
    std::string text;
    std::smatch at;
    auto from = endpoints.begin();
    for (; std::regex_search(from, endpoints.end(), at, port); from = at.suffix().first)
        text += at.prefix().str() + "-p " + std::to_string(std::stoi(at[1]) + place);
    return text + std::string(from, endpoints.end());
}

// Returns what publishes to the topic "vehicles" of an IceStorm service; null: none is given.
std::shared_ptr<Ice::ObjectPrx> publisherOf(const std::shared_ptr<Ice::Communicator>& ic,
                                            const std::string& topics) {
    if (topics.empty())
        return nullptr;
    const auto manager = Ice::checkedCast<IceStorm::TopicManagerPrx>(ic->stringToProxy(topics));
    try {
        return manager->create("vehicles")->getPublisher();
    } catch (const IceStorm::TopicExists&) {
        return manager->retrieve("vehicles")->getPublisher();
    }
}

std::shared_ptr<Ice::ObjectAdapter> adapterOf(const std::shared_ptr<Ice::Communicator>& ic,
                                              const std::string& name, const std::string& endpoints,
                                              const std::shared_ptr<Ice::Object>& servant) {
    const auto made = endpoints.empty() ? ic->createObjectAdapter(name)
                                        : ic->createObjectAdapterWithEndpoints(name, endpoints);
    made->addDefaultServant(servant, "");
    return made;
}

// Vehicle is one vehicle behind the modem, and the adapters that lead to it.
class Vehicle {
public:
    // `place`: of the vehicle in the fleet; its ports are that many above the given ones.
    Vehicle(const std::shared_ptr<Ice::Communicator>& ic, const Options& o, const Rights& rights,
            const std::string& name, int address, int place,
            const std::shared_ptr<Ice::ObjectPrx>& publisher)
        : forwarder(ic->stringToProxy("any:" + radioEndpoint(o, address)),
                    std::chrono::seconds(o.wait)),
          events(name, publisher),
          registration(name, forwarder, events,
                       [=, &o, &rights] {
                           const auto servant =
                               std::make_shared<ToVehicle>(forwarder, rights, false);
                           return adapterOf(ic, named("Clients"),
                                            portsAbove(endpointsOf(o.listen), place), servant);
                       }),
          place_(place) {
        const auto opened = registration.open();
        const int port = checkedPort(opened);
        if (ic->getDefaultLocator())
            opened->destroy(); // until the vehicle is here
        else
            adapters_.push_back(opened);
        if (!o.maintenance.empty())
            adapters_.push_back(adapterOf(ic, named("Maintenance"),
                                          portsAbove(endpointsOf(o.maintenance), place),
                                          std::make_shared<ToVehicle>(forwarder, rights, true)));
        const int maintenance = o.maintenance.empty() ? 0 : checkedPort(adapters_.back());
        forwarder.setCallbacks(adapterOf(ic, "", "", std::make_shared<ToClients>(forwarder)));
        std::shared_ptr<Ice::ObjectPrx> station;
        if (!o.station.empty())
            station = ic->stringToProxy("station:" + endpointsOf(o.station));
        adapterOf(ic, named("Radio"), radioEndpoint(o, address),
                  std::make_shared<ToStation>(station, o.station, publisher ? &events : nullptr))
            ->activate();
        const std::string what = o.vehicles.empty() ? "the UAV" : name;
        if (!ic->getDefaultLocator())
            std::cout << "gateway: port " << port << " leads to " << what << " behind " << o.device
                      << std::endl;
        if (maintenance)
            std::cout << "gateway: maintenance at port " << maintenance << std::endl;
        for (const auto& open : adapters_)
            open->activate();
    }

    Forwarder forwarder;
    const Events events;
    Registration registration;

private:
    std::string named(const char* adapter) const {
        return adapter + (place_ ? std::to_string(place_) : "");
    }
    const int place_;
    std::vector<std::shared_ptr<Ice::ObjectAdapter>> adapters_;
};

// Passes requests until the signal to stop.
void serve(const std::shared_ptr<Ice::Communicator>& ic, const Options& o) {
    const Rights rights = o.rights.empty() ? Rights() : Rights(o.rights);
    const auto publisher = publisherOf(ic, o.topics);
    std::list<Vehicle> vehicles;
    for (const auto& [name, address] : fleetOf(o))
        vehicles.emplace_back(ic, o, rights, name, address, int(vehicles.size()), publisher);
    const auto locator = ic->getDefaultLocator();
    const auto ask = [&](void (Registration::*question)(const std::shared_ptr<Ice::LocatorPrx>&)) {
        std::string trouble;
        try {
            for (Vehicle& vehicle : vehicles)
                (vehicle.registration.*question)(locator);
        } catch (const Ice::Exception& e) {
            trouble = e.ice_id();
        }
        return trouble;
    };
    sigset_t signals;
    sigemptyset(&signals);
    for (int signal : {SIGINT, SIGTERM, SIGHUP})
        sigaddset(&signals, signal);
    const timespec pause{0, Registration::lookMs * 1'000'000};
    for (std::string before; sigtimedwait(&signals, nullptr, &pause) < 0;) {
        for (Vehicle& vehicle : vehicles)
            vehicle.forwarder.failLateRequests();
        const std::string trouble = locator ? ask(&Registration::look) : "";
        if (!trouble.empty() && before.empty())
            std::cerr << "gateway: the registry does not answer: " + trouble + "\n";
        before = trouble;
    }
    if (locator)
        ask(&Registration::leave);
    for (Vehicle& vehicle : vehicles)
        vehicle.forwarder.stop();
    ic->destroy(); // while the objects that its callbacks use exist
}

} // namespace

int main(int argc, char** argv) {
    sigset_t signals; // every thread leaves them to sigtimedwait
    sigemptyset(&signals);
    for (int signal : {SIGINT, SIGTERM, SIGHUP})
        sigaddset(&signals, signal);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);

    CLI::App app{"A stock Ice server that passes requests to the UAV: Ice programs reach its "
                 "objects\nat a TCP port, e.g. by the proxy \"hwengine1:tcp -h 127.0.0.1 -p "
                 "10000\"."};
    Options o;
    addOptions(app, o);
    try {
        Ice::StringSeq words(argv + 1, argv + argc);
        Ice::InitializationData data;
        data.properties = Ice::createProperties(words);
        for (const char* prefix : {"IceSSL", "XBeeAT"})
            words = data.properties->parseCommandLineOptions(prefix, words);
        std::reverse(words.begin(), words.end());
        app.parse(words);
        setProperties(data.properties, o);
        Ice::CommunicatorHolder ic(data);
        serve(ic.communicator(), o);
    } catch (const CLI::ParseError& e) {
        return app.exit(e);
    } catch (const Ice::PluginInitializationException& e) {
        std::cerr << "gateway: error: " << e.reason << "\n";
        return 1;
    } catch (const std::exception& e) {
        std::cerr << "gateway: error: " << e.what() << "\n";
        return 1;
    }
    return 0;
}
