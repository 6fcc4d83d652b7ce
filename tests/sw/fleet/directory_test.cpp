// SPDX-License-Identifier: MIT
//
// directory_test: tests gateways together with IceGrid's registries and IceStorm, all as real
// processes. Stock clients find a vehicle by its name, continue to reach it when it moves from one
// ground station to another, and are notified of this.

#include "gateway_rig.h"
#include <IceSSL/IceSSL.h>
#include <IceStorm/IceStorm.h>
#include <filesystem>
#include <fstream>

namespace {

using Words = std::vector<std::string>;

Words with(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

// Returns a free port of 127.0.0.1 that is lower than the ports that the system assigns.
int freePort() {
    static int port = 20000 + getpid() % 1000 * 12;
    const Ice::CommunicatorHolder ic(Ice::initialize());
    for (;;)
        try {
            ic->createObjectAdapterWithEndpoints("",
                                                 "tcp -h 127.0.0.1 -p " + std::to_string(++port));
            return port;
        } catch (const Ice::SocketException&) {
        }
}

// A folder that is removed when this object is destroyed.
struct Folder {
    explicit Folder(const std::string& name)
        : path(testing::TempDir() + name + "." + std::to_string(getpid())) {
        std::filesystem::create_directories(path);
    }
    ~Folder() { std::filesystem::remove_all(path); }
    const std::string path;
};

// A registry of IceGrid, which can be killed and restarted.
class Registry {
public:
    // `protocol` is tcp or ssl. `more` contains the options for the certificate and, for a replica,
    // the locator of the master.
    Registry(const std::string& name, const std::string& protocol, const Words& more)
        : here_(protocol + " -h 127.0.0.1"), folder_("registry." + name),
          words_(with({PROGRAMS "/icegridregistry", "--IceGrid.InstanceName=IceGrid",
                       "--IceGrid.Registry.ReplicaName=" + name,
                       "--IceGrid.Registry.Client.Endpoints=" + endpoint(),
                       "--IceGrid.Registry.Server.Endpoints=" + here_,
                       "--IceGrid.Registry.Internal.Endpoints=" + here_,
                       "--IceGrid.Registry.Discovery.Enabled=0",
                       "--IceGrid.Registry.DynamicRegistration=1",
                       "--IceGrid.Registry.LMDB.Path=" + folder_.path,
                       "--IceGrid.Registry.LMDB.MapSize=8", "--Ice.PrintAdapterReady=1"},
                      more)) {
        start();
    }
    void start() {
        process_ = std::make_unique<Server>(words_);
        if (!process_->hear("Registry.Client ready"))
            throw std::runtime_error("no registry: " + process_->said());
    }
    void kill() {
        ::kill(process_->pid(), SIGKILL);
        process_->wait();
    }
    std::string endpoint() const { return here_ + " -p " + std::to_string(port_); }

private:
    const std::string here_;
    const int port_ = freePort();
    const Folder folder_;
    const Words words_;
    std::unique_ptr<Server> process_;
};

class Directory : public Gateway {
protected:
    // `isSecure`: true if the machines use TLS between them, and the vehicle has a key.
    explicit Directory(bool isSecure = false) : isSecure_(isSecure) {
        rig_.placeOther(rig_.elsewhere);
    }
    // Returns the options of Ice that set a certificate for IceSSL; empty without encryption.
    Words certificate() const {
        if (!isSecure_)
            return {};
        Ice::registerIceSSL();
        const std::string pem = secrets_.path + "/fleet.pem";
        if (!std::filesystem::exists(pem) &&
            std::system((ICESOC " key " + pem + " --certificate >" + pem + ".said").c_str()) != 0)
            throw std::runtime_error("no certificate");
        return {"--Ice.Plugin.IceSSL=IceSSL:createIceSSL",
                "--IceSSL.CAs=" + secrets_.path + "/authority.pem", "--IceSSL.CertFile=" + pem};
    }
    // Gives the vehicle a key. Returns the path of the key file.
    std::string key() {
        const std::string path = secrets_.path + "/my.key";
        std::ofstream(path) << std::string(32, '5');
        std::filesystem::permissions(path, std::filesystem::perms(0600));
        const std::vector<U8> key(LINK_KEY_BYTES, 0x55);
        rig_.with([&] { Link_setKey(rig_.uav.link(), 0, key.data(), 1); });
        return path;
    }
    // Moves the vehicle into reach of the first ground station (`isHome`), or of the second one.
    void fly(bool isHome) {
        rig_.with([&] { rig_.uav.move(isHome ? rig_.air : rig_.elsewhere); });
    }
    std::string locator() const {
        return "IceGrid/Locator:" + master_.endpoint() + ":" + replica_.endpoint();
    }
    std::unique_ptr<Server> ground(const std::string& port, const Words& more = {}) {
        return std::make_unique<Server>(
            with(with({GATEWAY, "-d", port, "-g", std::to_string(Rig::guardMs), "-l",
                       protocol_ + " -h 127.0.0.1 -p 0", "--Ice.Default.Locator=" + locator()},
                      certificate_),
                 more));
    }
    Ice::CommunicatorPtr client() const {
        auto data = Ice::InitializationData();
        data.properties = Ice::createProperties();
        data.properties->parseCommandLineOptions("", certificate_);
        data.properties->setProperty("Ice.Default.Locator", locator());
        data.properties->setProperty("Ice.Default.InvocationTimeout", "1800000");
        data.properties->setProperty("Ice.RetryIntervals", "0 100 200 400 800");
        return Ice::initialize(data);
    }
    void followAVehicle(const Words& more);
    // Calls repeatedly until a reply arrives. Returns the number of earlier calls for which
    // the client does not know whether they were executed.
    int callOn(const std::shared_ptr<RadioTest::UavPrx>& echo) {
        for (int unknown = 0;;)
            try {
                ++id_;
                EXPECT_EQ(echo->repeat(id_, {1, 2}), (RadioTest::Bytes{1, 2}));
                return unknown;
            } catch (const Ice::NotRegisteredException&) {
            } catch (const Ice::UnknownException&) {
                ++unknown;
            }
    }

    const bool isSecure_;
    const std::string protocol_ = isSecure_ ? "ssl" : "tcp";
    const Folder secrets_{"fleet"};
    const Words certificate_ = certificate();
    Registry master_{"Master", protocol_, certificate_};
    Registry replica_{
        "Replica", protocol_,
        with(certificate_, {"--Ice.Default.Locator=IceGrid/Locator:" + master_.endpoint()})};
    Rig& rig_ = world_.rig;
    int id_ = 0;
};

struct SecureDirectory : Directory {
    SecureDirectory() : Directory(true) {}
};

void Directory::followAVehicle(const Words& more) {
    auto home = ground(rig_.pty.path(),
                       with({"-t", "1", "--vehicle", "uav7=1", "--vehicle", "uav8=8"}, more));
    auto other = ground(rig_.otherPty.path(), with({"--vehicle", "uav7=1"}, more));
    ASSERT_TRUE(home->hear("uav7 is here")) << home->said();
    Ice::CommunicatorHolder ic(client());
    const auto echo = Ice::uncheckedCast<RadioTest::UavPrx>(ic->stringToProxy("echo@uav7"));
    EXPECT_EQ(callOn(echo), 0);
    EXPECT_THROW(ic->stringToProxy("echo@uav8")->ice_ping(), Ice::NotRegisteredException) << "away";
    Server python(with({"/usr/bin/python3", "-c",
                        "import Ice, sys; ic = Ice.initialize(sys.argv)\n"
                        "ic.stringToProxy('echo@uav7').ice_ping(); ic.destroy()",
                        "--Ice.Default.Locator=" + locator()},
                       certificate_));
    EXPECT_EQ(python.wait(), 0) << python.said();
    for (bool isHome : {false, true}) {
        fly(isHome);
        const double since = rig_.seconds();
        if (isHome)
            EXPECT_NO_THROW(echo->ice_ping())
                << "the operation is idempotent, so Ice repeats the call";
        else
            EXPECT_LE(callOn(echo), 1) << "only a call that was in progress may fail";
        const double seconds = rig_.seconds() - since;
        std::printf("directory: handed over after %.2f s\n", seconds);
        EXPECT_LT(seconds, 5);
        ASSERT_TRUE(isHome || home->hear("0x0001: link connecting")) << home->said();
    }
    EXPECT_EQ(world_.echo->twice(), 0);
    EXPECT_EQ(home->stop() + other->stop(), 0);
    EXPECT_THROW(echo->ice_ping(), Ice::NotRegisteredException)
        << "both ground stations have ended";
}

TEST_F(Directory, ClientsFollowAVehicleFromOneGroundToAnother) {
    followAVehicle({});
}

TEST_F(SecureDirectory, ClientsFollowAVehicleFromOneGroundToAnother) {
    followAVehicle({"--key", key()});
    Ice::CommunicatorHolder stranger(program({{"Ice.Plugin.IceSSL", "IceSSL:createIceSSL"}}));
    EXPECT_THROW(stranger->stringToProxy(locator())->ice_ping(), Ice::LocalException)
        << "a client without a certificate must be refused";
}

// The vehicle is in reach of both ground stations, which have the same address and key.
TEST_F(Directory, AGroundThatTakesOverKeepsTheVehicleUntilItEnds) {
    rig_.placeOther(rig_.air);
    const std::string file = key();
    auto home = ground(rig_.pty.path(), {"-t", "1", "--key", file});
    ASSERT_TRUE(home->hear("uav1 is here")) << home->said();
    Ice::CommunicatorHolder ic(client());
    const auto echo = Ice::uncheckedCast<RadioTest::UavPrx>(ic->stringToProxy("echo@uav1"));
    EXPECT_EQ(callOn(echo), 0);
    auto other = ground(rig_.otherPty.path(), {"--key", file});
    ASSERT_TRUE(other->hear("uav1 is here")) << other->said();
    EXPECT_LE(callOn(echo), 1);
    ASSERT_TRUE(home->hear("uav1 is elsewhere")) << home->said();
    for (const double end = rig_.seconds() + 15; rig_.seconds() < end;)
        EXPECT_EQ(callOn(echo), 0);
    EXPECT_EQ(other->stop(), 0);
    EXPECT_EQ(other->said().find("elsewhere"), std::string::npos)
        << other->said() << (home->stop(), home->said());
    ASSERT_TRUE(home->hear("another ground station with the same address")) << home->said();
    ASSERT_TRUE(home->hear("uav1 is here")) << home->said();
    callOn(echo);
    EXPECT_EQ(world_.echo->twice(), 0);
}

TEST_F(Directory, OneOfTwoRegistriesMayFailAndReturn) {
    auto home = ground(rig_.pty.path()), other = ground(rig_.otherPty.path());
    ASSERT_TRUE(home->hear("uav1 is here")) << home->said();
    Ice::CommunicatorHolder ic(client());
    const auto echoOf = [](const Ice::CommunicatorPtr& by) {
        return Ice::uncheckedCast<RadioTest::UavPrx>(by->stringToProxy("echo@uav1"));
    };
    EXPECT_EQ(callOn(echoOf(ic.communicator())), 0);
    master_.kill();
    EXPECT_EQ(callOn(echoOf(ic.communicator())), 0)
        << "a client that already knows the endpoint needs no master";
    {
        Ice::CommunicatorHolder late(client());
        EXPECT_EQ(callOn(echoOf(late.communicator())), 0)
            << "a new client must get the endpoint from the replica";
    }
    fly(false); // while the master is down, the registry cannot be updated
    ASSERT_TRUE(other->hear("does not answer")) << other->said();
    master_.start();
    ASSERT_TRUE(other->hear("uav1 is here")) << other->said();
    Ice::CommunicatorHolder late(client());
    EXPECT_EQ(callOn(echoOf(late.communicator())), 0);
    callOn(echoOf(ic.communicator()));
    EXPECT_EQ(world_.echo->twice(), 0);
}

// Records the events that it receives: the name of the vehicle, the vehicle's proxy, and the bytes
// of the other parameters.
class Subscriber : public Ice::Blobject {
public:
    bool ice_invoke(std::vector<Ice::Byte> in, std::vector<Ice::Byte>&,
                    const Ice::Current& current) override {
        const auto ic = current.adapter->getCommunicator();
        Ice::InputStream parameters(ic, in);
        std::shared_ptr<Ice::ObjectPrx> vehicle;
        parameters.startEncapsulation();
        parameters.read(vehicle);
        std::lock_guard<std::mutex> lock(mutex_);
        heard_ += current.operation + " " + current.ctx.at("vehicle") + " " +
                  (vehicle ? Ice::identityToString(vehicle->ice_getIdentity()) + "@" +
                                 vehicle->ice_getAdapterId()
                           : "none") +
                  " " + std::to_string(parameters.b.end() - parameters.i) + "\n";
        return true;
    }
    std::string heard() {
        std::lock_guard<std::mutex> lock(mutex_);
        return heard_;
    }

private:
    std::mutex mutex_;
    std::string heard_;
};

TEST_F(Directory, ATopicReportsArrivingAndLeavingVehicles) {
    const std::string topics =
        "IceStorm/TopicManager:tcp -h 127.0.0.1 -p " + std::to_string(freePort());
    Server storm({PROGRAMS "/icebox",
                  "--IceBox.Service.IceStorm=IceStormService,37:createIceStorm "
                  "--IceStorm.TopicManager.Endpoints='" +
                      topics.substr(topics.find(':') + 1) +
                      "' --IceStorm.Publish.Endpoints='tcp -h 127.0.0.1' --IceStorm.Transient=1",
                  "--IceBox.PrintServicesReady=IceStorm"});
    ASSERT_TRUE(storm.hear("IceStorm ready")) << storm.said();
    Ice::CommunicatorHolder ic(client());
    const auto subscriber = std::make_shared<Subscriber>();
    const auto adapter = ic->createObjectAdapterWithEndpoints("", "tcp -h 127.0.0.1");
    adapter->activate();
    Ice::checkedCast<IceStorm::TopicManagerPrx>(ic->stringToProxy(topics))
        ->create("vehicles")
        ->subscribeAndGetPublisher({{"reliability", "ordered"}}, adapter->addWithUUID(subscriber));
    auto home = ground(rig_.pty.path(), {"--topics", topics});
    ASSERT_TRUE(home->hear("uav1 is here")) << home->said();
    const auto uav = world_.uav;
    const auto station = uav->getCommunicator()->stringToProxy(world_.echo->station);
    Ice::OutputStream out(uav->getCommunicator());
    out.startEncapsulation();
    out.write(std::shared_ptr<Ice::ObjectPrx>(uav->createProxy({"uav", ""})));
    out.write(std::string("parameters"));
    out.endEncapsulation();
    std::vector<Ice::Byte> parameters, answer;
    out.finished(parameters);
    EXPECT_TRUE(
        station->ice_invoke("vehicleState", Ice::OperationMode::Normal, parameters, answer));
    rig_.with([&] { rig_.uav.modem->power(false, rig_.ns()); });
    ASSERT_TRUE(home->hear("uav1 has left")) << home->said();
    const std::string events = "vehicleState uav1 uav@uav1 1\n"
                               "vehicleState uav1 uav@uav1 11\n"
                               "vehicleState uav1 none 1\n";
    rig_.until([&] { return subscriber->heard().size() >= events.size(); });
    EXPECT_EQ(subscriber->heard(), events);
    rig_.with([&] { rig_.uav.modem->power(true, rig_.ns()); });
    ASSERT_TRUE(home->hear("uav1 is here")) << home->said();
}

} // namespace
