// SPDX-License-Identifier: MIT
//
// gateway: an Ice server that passes requests to the vehicle. Several Ice programs, in any language
// and of any version, can call the vehicle's objects through the gateway at the same time. The
// vehicle's calls reach a server on the ground.
//
// Endpoints, TLS, WebSocket, compression and connections are handled by unmodified Ice; forwarder.h
// shares the radio.

#include "gateway_options.h"
#include "log.h"
#include "pages.h"
#include "reason.h"
#include "registration.h"
#include "rights.h"

#include <IceSSL/IceSSL.h>
#include <IceSSL/OpenSSL.h>
#include <IceStorm/IceStorm.h>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <future>
#include <iostream>
#include <list>
#include <openssl/ssl.h>
#include <thread>
#include <unistd.h>

namespace {

using namespace gateway;

using Take = std::function<void(std::shared_ptr<Request>)>;

// Servant handles the calls to all objects of an adapter.
class Servant : public Ice::BlobjectArrayAsync {
public:
    explicit Servant(Take take) : take_(std::move(take)) {}
    void ice_invokeAsync(Parameters in, Response response, Failure failed,
                         const Ice::Current& current) override {
        const auto inform = [failed](std::exception_ptr why) { failed(inWords(why)); };
        try {
            take_(std::make_shared<Request>(in, std::move(response), inform, current));
        } catch (const Ice::Exception&) {
            inform(std::current_exception());
        }
    }
    // Ice calls this function to dispatch a request. It fails if the request's parameters are not a
    // valid encapsulation.
    bool _iceDispatch(IceInternal::Incoming& in, const Ice::Current& current) override {
        try {
            return Ice::BlobjectArrayAsync::_iceDispatch(in, current);
        } catch (const Ice::LocalException&) {
            std::rethrow_exception(inWords(std::current_exception()));
        }
    }

private:
    const Take take_;
};

// Returns the subject that is charged for the requests of a connection: the subject of the client's
// certificate, or without a certificate the client's host.
std::string turnOf(const std::shared_ptr<Ice::Connection>& connection, const std::string& subject) {
    if (!subject.empty())
        return subject;
    for (auto info = connection->getInfo(); info; info = info->underlying)
        if (const auto ip = std::dynamic_pointer_cast<Ice::IPConnectionInfo>(info))
            return ip->remoteAddress;
    return "";
}

// Returns a function that passes a client's call to the vehicle if --rights permits the call, and
// if `pages` does not refuse the web page from which the call comes. Without `allowsMaintenance`,
// this function refuses calls to objects that change keys or programs.
Take toVehicle(Forwarder& forwarder, const Rights& rights, const Pages& pages,
               bool allowsMaintenance) {
    return [&forwarder, &rights, &pages, allowsMaintenance](std::shared_ptr<Request> request) {
        const Ice::Current& current = request->current;
        const std::string identity = Ice::identityToString(current.id);
        const std::string subject = subjectOf(current.con);
        const std::string refusal = pages.refusal(current.con);
        if (!refusal.empty())
            return request->failed(std::make_exception_ptr(
                Ice::UnknownException(__FILE__, __LINE__, "icesoc-gateway: " + refusal)));
        if (rights.permit(subject, identity, current.operation)) {
            request->subject = turnOf(current.con, subject);
            request->mayMaintain = allowsMaintenance;
            return forwarder.take(std::move(request));
        }
        request->failed(std::make_exception_ptr(
            Ice::UnknownException(__FILE__, __LINE__,
                                  "icesoc-gateway: '" + subject + "' has no right to call " +
                                      current.operation + " of '" + identity + "'")));
    };
}

// Returns a function that passes the vehicle's calls to the object `station` at the endpoint
// `where`, or to the topic of `events`. `vehicle` is a proxy by which programs on the ground can
// call the vehicle.
Take toStation(const std::shared_ptr<Ice::ObjectPrx>& station, const std::string& where,
               const Events* events, const std::shared_ptr<Ice::ObjectPrx>& vehicle) {
    return [=](const std::shared_ptr<Request>& request) {
        if (events)
            return events->pass(*request, request->response, request->failed);
        const Ice::Current& current = request->current;
        if (!station)
            throw Ice::ObjectNotExistException(__FILE__, __LINE__, current.id, current.facet,
                                               current.operation);
        replaceVehicle(*request, station->ice_getCommunicator(), [&](const auto& named) {
            return vehicle->ice_identity(named->ice_getIdentity())
                ->ice_facet(named->ice_getFacet())
                ->ice_encodingVersion(named->ice_getEncodingVersion());
        });
        request->sendTo(station, request->response, [request, where](std::exception_ptr why) {
            try {
                std::rethrow_exception(why);
            } catch (const Ice::SocketException& e) {
                std::cerr
                    << "gateway: cannot pass on a call of the vehicle: no server listens at " +
                           where + ": " + reasonOf(e) + "\n";
            } catch (...) {
            }
            request->failed(why);
        });
    };
}

// Prevents the resumption of TLS sessions. IceSSL receives a client's certificate only in a full
// handshake, and browsers resume sessions.
void refuseResumption(const std::shared_ptr<Ice::Communicator>& ic) {
    try {
        const auto plugin = ic->getPluginManager()->getPlugin("IceSSL");
        if (const auto openSsl = std::dynamic_pointer_cast<IceSSL::OpenSSL::Plugin>(plugin)) {
            SSL_CTX_set_session_cache_mode(openSsl->getContext(), SSL_SESS_CACHE_OFF);
            SSL_CTX_set_options(openSsl->getContext(), SSL_OP_NO_TICKET);
            SSL_CTX_set_num_tickets(openSsl->getContext(), 0);
        }
    } catch (const Ice::NotRegisteredException&) { // no TLS
    }
}

// Returns the port of the first endpoint of an adapter. Throws an exception if one of the endpoints
// accepts unencrypted calls from other machines.
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
            throw std::runtime_error("'" + endpoint->toString() +
                                     "' accepts unencrypted calls from other machines: listen at "
                                     "127.0.0.1, or use an ssl endpoint");
    }
    return port;
}

// Returns the publisher of the topic "vehicles" of an IceStorm service. Returns null without the
// option --topics.
std::shared_ptr<Ice::ObjectPrx> publisherOf(const std::shared_ptr<Ice::Communicator>& ic,
                                            const std::string& topics) {
    if (topics.empty())
        return nullptr;
    const auto manager = [&] {
        try {
            return Ice::checkedCast<IceStorm::TopicManagerPrx>(ic->stringToProxy(topics));
        } catch (const Ice::SocketException& e) {
            throw std::runtime_error("--topics: " + reasonOf(e));
        }
    }();
    try {
        return manager->create("vehicles")->getPublisher();
    } catch (const IceStorm::TopicExists&) {
        return manager->retrieve("vehicles")->getPublisher();
    }
}

std::shared_ptr<Ice::ObjectAdapter> adapterOf(const std::shared_ptr<Ice::Communicator>& ic,
                                              const std::string& name, const std::string& endpoints,
                                              Take take) {
    const auto made = [&] {
        try {
            return endpoints.empty() ? ic->createObjectAdapter(name)
                                     : ic->createObjectAdapterWithEndpoints(name, endpoints);
        } catch (const Ice::ConnectFailedException&) {
            throw; // the modem's serial port has failed
        } catch (const Ice::SocketException& e) {
            const std::string place = endpoints.empty()
                                          ? ic->getProperties()->getProperty(name + ".Endpoints")
                                          : endpoints;
            throw std::runtime_error("cannot listen at " + place + ": " + reasonOf(e));
        }
    }();
    made->addDefaultServant(std::make_shared<Servant>(std::move(take)), "");
    return made;
}

// Vehicle is one vehicle that the modem reaches, with the adapters for its clients.
class Vehicle {
public:
    // Creates a vehicle. `place` is the vehicle's number in the fleet, from 0; it is added to the
    // ports given on the command line.
    Vehicle(const std::shared_ptr<Ice::Communicator>& ic, const Options& o, const Rights& rights,
            Pages& pages, const std::string& name, int address, int place,
            const std::shared_ptr<Ice::ObjectPrx>& publisher)
        : forwarder(ic->stringToProxy("any:" + radioEndpoint(o, address)),
                    std::chrono::seconds(o.wait)),
          events(name, publisher),
          registration(
              name, forwarder, events,
              [=, &rights, &pages] {
                  const auto properties = ic->getProperties();
                  const bool hasCertificate = !properties->getProperty("IceSSL.CertFile").empty();
                  return adapterOf(ic, named("Clients"),
                                   endpointsOf(pages.endpoints(hasCertificate), place),
                                   toVehicle(forwarder, rights, pages, false));
              },
              ic->getDefaultLocator()),
          place_(place) {
        const auto opened = registration.open();
        const int port = checkedPort(opened);
        pages.add(name, opened);
        const auto reached = ic->getDefaultLocator()
                                 ? ic->stringToProxy("uav@" + name)
                                 : opened->createDirectProxy(Ice::stringToIdentity("uav"));
        if (ic->getDefaultLocator())
            opened->destroy(); // Registration opens the adapter again when the vehicle is connected
        else
            adapters_.push_back(opened);
        if (!o.maintenance.empty())
            adapters_.push_back(adapterOf(ic, named("Maintenance"),
                                          endpointsOf(o.maintenance, place),
                                          toVehicle(forwarder, rights, pages, true)));
        const int maintenance = o.maintenance.empty() ? 0 : checkedPort(adapters_.back());
        forwarder.setCallbacks(adapterOf(ic, "", "", [this](std::shared_ptr<Request> request) {
            forwarder.takeCallback(std::move(request));
        }));
        std::shared_ptr<Ice::ObjectPrx> station;
        if (!o.station.empty())
            station = ic->stringToProxy("station:" + endpointsOf(o.station));
        adapterOf(ic, named("Radio"), radioEndpoint(o, address),
                  toStation(station, o.station, publisher ? &events : nullptr, reached))
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

// Returns the set of signals that stop the gateway.
sigset_t endings() {
    sigset_t signals;
    sigemptyset(&signals);
    for (int signal : {SIGINT, SIGTERM, SIGHUP})
        sigaddset(&signals, signal);
    return signals;
}

// Ends Ice. Ice first waits until each request that it has read has a reply, but it never replies
// to a message with an absurd length, because it cannot allocate the memory. If Ice has not ended
// after `longest`, this function ends the process.
void destroy(const std::shared_ptr<Ice::Communicator>& ic, std::chrono::seconds longest) {
    std::promise<void> ended;
    std::thread thread([&] {
        ic->destroy();
        ended.set_value();
    });
    if (ended.get_future().wait_for(longest) == std::future_status::timeout) {
        std::cerr << "gateway: the connection of a client did not end within " << longest.count()
                  << " s" << std::endl;
        _exit(0);
    }
    thread.join();
}

// Passes requests until a signal stops the gateway.
void serve(const std::shared_ptr<Ice::Communicator>& ic, const Options& o) {
    refuseResumption(ic);
    const Rights rights = o.rights.empty() ? Rights() : Rights(o.rights);
    const auto publisher = publisherOf(ic, o.topics);
    Pages pages(o);
    if (!o.page.empty() && ic->getDefaultLocator())
        throw std::runtime_error("--page and --Ice.Default.Locator exclude each other, because the "
                                 "ports of registered vehicles change");
    std::list<Vehicle> vehicles;
    for (const auto& [name, address] : fleetOf(o))
        vehicles.emplace_back(ic, o, rights, pages, name, address, int(vehicles.size()), publisher);
    pages.start(ic->getProperties()->getProperty("IceSSL.CertFile"));
    // Calls a function of the registration of each vehicle. Returns the text of the first error;
    // empty if all calls succeed or no registry is configured.
    const auto ask = [&](void (Registration::*question)()) -> std::string {
        try {
            for (Vehicle& vehicle : vehicles)
                if (ic->getDefaultLocator())
                    (vehicle.registration.*question)();
            return "";
        } catch (const Ice::Exception& e) {
            return reasonOf(e);
        }
    };
    const sigset_t signals = endings();
    const timespec pause{0, Registration::lookMs * 1'000'000};
    for (std::string before; sigtimedwait(&signals, nullptr, &pause) < 0;) {
        pages.check();
        for (Vehicle& vehicle : vehicles)
            vehicle.forwarder.failLateRequests();
        const std::string trouble = ask(&Registration::look);
        if (!trouble.empty() && before.empty())
            std::cerr << "gateway: the registry does not answer: " + trouble + "\n";
        before = trouble;
    }
    ask(&Registration::leave);
    for (Vehicle& vehicle : vehicles)
        vehicle.forwarder.stop();
    pages.stop();
    destroy(ic, std::chrono::seconds(
                    o.end)); // here, while the objects that Ice's callbacks use still exist
}

} // namespace

int main(int argc, char** argv) {
    // these signals are blocked in all threads; sigtimedwait receives them
    const sigset_t signals = endings();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);

    CLI::App app{
        "An Ice server at the ground station's modem. It forwards the calls of Ice programs to\n"
        "the vehicle, and the vehicle's calls to a server. A program reaches an object of the\n"
        "vehicle at a TCP port, for example with the proxy\n"
        "\"hwengine1:tcp -h 127.0.0.1 -p 10000\".",
        "icesoc-gateway"};
    Options o;
    addOptions(app, o);
    try {
        Ice::StringSeq words(argv, argv + argc);
        Ice::InitializationData data;
        // the name of the program, which is the first word, appears in the log
        data.properties = Ice::createProperties(words);
        words.erase(words.begin());
        for (const char* prefix : {"IceSSL", "XBeeAT"})
            words = data.properties->parseCommandLineOptions(prefix, words);
        std::reverse(words.begin(), words.end());
        app.parse(words); // reports unknown options, even if the device is missing as well
        if (o.device.empty())
            throw CLI::RequiredError("--device");
        setProperties(data.properties, o);
        installLog();
        Ice::CommunicatorHolder ic(data);
        serve(ic.communicator(), o);
    } catch (const CLI::ParseError& e) {
        return app.exit(e);
    } catch (const Ice::ConnectFailedException& e) {
        // the modem's serial port has failed; the plugin has already logged the details
        std::cerr << "gateway: error: cannot use " << o.device << ": " << reasonOf(e) << "\n";
        return 1;
    } catch (const Ice::Exception& e) {
        std::cerr << "gateway: error: " << reasonOf(e) << "\n";
        return 1;
    } catch (const std::exception& e) {
        std::cerr << "gateway: error: " << e.what() << "\n";
        return 1;
    }
    return 0;
}
