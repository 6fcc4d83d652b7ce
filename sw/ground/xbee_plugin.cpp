// SPDX-License-Identifier: MIT
//
// xbee_plugin: the xbee-at transport of ZeroC Ice 3.7. One source, two libraries: for the C++98
// mapping (which Python loads) and for the C++11 mapping. It links to ZeroC Ice, which is GPL-2.0.

#include "engine.h"

#include <Ice/Acceptor.h>
#include <Ice/Buffer.h>
#include <Ice/Connection.h>
#include <Ice/Connector.h>
#include <Ice/EndpointFactory.h>
#include <Ice/EndpointI.h>
#include <Ice/Ice.h>
#include <Ice/Network.h>
#include <Ice/ProtocolPluginFacade.h>
#include <Ice/Transceiver.h>

#include <cerrno>
#include <cstdlib>
#include <sstream>
#include <sys/socket.h>
#include <unistd.h>

namespace {

using namespace std;
using IceInternal::EndpointIPtr;

const Ice::Short endpointType = 0x4158;
const string protocolName = "xbee-at";
const Ice::Int defaultTimeoutMs = 30000; // setting a modem up takes seconds

struct Options {
    XBeeAT::Settings serial;
    int channel = 255; // logical, 255: any
    Ice::Int timeoutMs = defaultTimeoutMs;
    string connectionId;
    bool compress = false;
};

// The key itself is in no message.
void checkKey(const string& key, const string& where) {
    if (key.size() > 32 || key.find_first_not_of("0123456789abcdefABCDEF") != string::npos)
        throw Ice::EndpointParseException(
            __FILE__, __LINE__, "the AES key of " + where + " must be up to 32 hexadecimal digits");
}

// What the endpoints of one communicator share: its properties and its logger.
class Instance : public IceUtil::Shared {
public:
    explicit Instance(const Ice::CommunicatorPtr& communicator) : communicator_(communicator) {
        Ice::PropertiesPtr p = communicator->getProperties();
        trace_ = p->getPropertyAsInt("XBeeAT.Trace");
        statistics_ = p->getPropertyAsInt("XBeeAT.Statistics") > 0;
        defaults_.serial.device = p->getProperty("XBeeAT.Device");
        defaults_.serial.baud = p->getPropertyAsIntWithDefault("XBeeAT.Baud", 115200);
        defaults_.serial.guardMs = p->getPropertyAsIntWithDefault("XBeeAT.Guard", 1000);
        defaults_.serial.key = p->getProperty("XBeeAT.Key");
        checkKey(defaults_.serial.key, "property XBeeAT.Key");
        defaults_.serial.downMs = 1000 * p->getPropertyAsIntWithDefault("XBeeAT.Down", 15);
        defaults_.serial.setUp = p->getPropertyAsIntWithDefault("XBeeAT.Setup", 1) > 0;
    }
    const Options& defaults() const { return defaults_; }

    shared_ptr<XBeeAT::Engine> engine(const Options& o) {
        Ice::LoggerPtr logger = communicator_->getLogger();
        int trace = trace_;
        try {
            engine_ = XBeeAT::Engine::get(o.serial, [logger, trace](int level, const string& text) {
                if (level == 0)
                    logger->error("xbee-at: " + text);
                else if (level <= trace)
                    logger->trace("XBeeAT", text);
            });
        } catch (const system_error& e) {
            logger->error(string("xbee-at: ") + e.what());
            throw Ice::ConnectFailedException(__FILE__, __LINE__, e.code().value());
        }
        return engine_;
    }
    void destroy() {
        if (engine_ && statistics_)
            communicator_->getLogger()->print("xbee-at: " + engine_->statistics());
        engine_.reset();
        communicator_ = ICE_NULLPTR;
    }

private:
    Ice::CommunicatorPtr communicator_;
    Options defaults_;
    int trace_ = 0;
    bool statistics_ = false;
    shared_ptr<XBeeAT::Engine> engine_; // kept while the communicator lives: set-up takes seconds
};
typedef IceUtil::Handle<Instance> InstancePtr;

class Transceiver : public IceInternal::Transceiver, public IceInternal::NativeInfo {
public:
    Transceiver(const shared_ptr<XBeeAT::Engine>& engine, int fd)
        : IceInternal::NativeInfo(fd), engine_(engine) {}
    IceInternal::NativeInfoPtr getNativeInfo() override { return this; }
    IceInternal::SocketOperation initialize(IceInternal::Buffer&, IceInternal::Buffer&) override {
        // Ice waits for the peer's first message next, under the connect time-out: that is "link
        // up".
        return IceInternal::SocketOperationNone;
    }
    IceInternal::SocketOperation closing(bool initiator, const Ice::LocalException&) override {
        return initiator ? IceInternal::SocketOperationRead : IceInternal::SocketOperationNone;
    }
    void close() override {
        ::close(_fd);
        _fd = INVALID_SOCKET;
    }
    IceInternal::SocketOperation write(IceInternal::Buffer& buf) override {
        while (buf.i != buf.b.end()) {
            ssize_t count =
                ::send(_fd, &*buf.i, static_cast<size_t>(buf.b.end() - buf.i), MSG_NOSIGNAL);
            if (count > 0)
                buf.i += count;
            else if (errno == EAGAIN)
                return IceInternal::SocketOperationWrite;
            else if (errno != EINTR)
                lost();
        }
        return IceInternal::SocketOperationNone;
    }
    IceInternal::SocketOperation read(IceInternal::Buffer& buf) override {
        while (buf.i != buf.b.end()) {
            ssize_t count = ::recv(_fd, &*buf.i, static_cast<size_t>(buf.b.end() - buf.i), 0);
            if (count > 0) {
                buf.i += count;
                heard_ = true;
            } else if (count < 0 && errno == EAGAIN)
                return IceInternal::SocketOperationRead;
            else if (count == 0 || errno != EINTR)
                lost();
        }
        return IceInternal::SocketOperationNone;
    }
    string protocol() const override { return protocolName; }
    string toString() const override { return protocolName + " " + engine_->device(); }
    string toDetailedString() const override { return toString(); }
    Ice::ConnectionInfoPtr getInfo() const override { return ICE_MAKE_SHARED(Ice::ConnectionInfo); }
    void checkSendSize(const IceInternal::Buffer& buf) override {
        if (buf.b.size() > LINK_MAX_MESSAGE)
            throw Ice::MemoryLimitException(__FILE__, __LINE__,
                                            "message too long for the radio link (at most " +
                                                to_string(LINK_MAX_MESSAGE) + " bytes)");
    }
    void setBufferSize(int, int) override {}

private:
    [[noreturn]] void lost() {
        if (heard_)
            throw Ice::ConnectionLostException(__FILE__, __LINE__, 0);
        throw Ice::ConnectFailedException(__FILE__, __LINE__, ENOLINK);
    }
    shared_ptr<XBeeAT::Engine> engine_;
    bool heard_ = false;
};

class Connector : public IceInternal::Connector {
public:
    Connector(const InstancePtr& instance, const Options& options)
        : instance_(instance), options_(options) {}
    IceInternal::TransceiverPtr connect() override {
        auto engine = instance_->engine(options_);
        int fd = engine->connect(options_.channel == 255 ? -1 : options_.channel);
        if (fd < 0) // all channels are taken, or the modem was given up
            throw Ice::ConnectFailedException(__FILE__, __LINE__, EBUSY);
        return new Transceiver(engine, fd);
    }
    Ice::Short type() const override { return endpointType; }
    string toString() const override { return options_.serial.device; }
    bool operator==(const IceInternal::Connector& other) const override {
        const Connector* o = dynamic_cast<const Connector*>(&other);
        return o && key() == o->key();
    }
    bool operator<(const IceInternal::Connector& other) const override {
        const Connector* o = dynamic_cast<const Connector*>(&other);
        return o ? key() < o->key() : type() < other.type();
    }

private:
    string key() const {
        return options_.serial.device + " " + to_string(options_.channel) + " " +
               to_string(options_.timeoutMs) + " " + options_.connectionId;
    }
    InstancePtr instance_;
    Options options_;
};

class Acceptor : public IceInternal::Acceptor, public IceInternal::NativeInfo {
public:
    Acceptor(const InstancePtr& instance, const Options& options, const EndpointIPtr& endpoint)
        : engine_(instance->engine(options)), endpoint_(endpoint) {}
    IceInternal::NativeInfoPtr getNativeInfo() override { return this; }
    void close() override {
        if (_fd != INVALID_SOCKET)
            engine_->stopListening();
        _fd = INVALID_SOCKET;
    }
    EndpointIPtr listen() override {
        _fd = engine_->listen();
        if (_fd < 0)
            throw Ice::SocketException(__FILE__, __LINE__, EADDRINUSE);
        return endpoint_;
    }
    IceInternal::TransceiverPtr accept() override {
        int fd = engine_->accept();
        if (fd < 0)
            throw Ice::SocketException(__FILE__, __LINE__, EAGAIN);
        return new Transceiver(engine_, fd);
    }
    string protocol() const override { return protocolName; }
    string toString() const override { return protocolName + " " + engine_->device(); }
    string toDetailedString() const override { return toString(); }

private:
    shared_ptr<XBeeAT::Engine> engine_;
    EndpointIPtr endpoint_;
};

class Endpoint : public IceInternal::EndpointI
#ifdef ICE_CPP11_MAPPING
    ,
                 public enable_shared_from_this<Endpoint>
#endif
{
public:
    Endpoint(const InstancePtr& instance, const Options& options)
        : instance_(instance), o_(options) {}

    void streamWriteImpl(Ice::OutputStream* s) const override {
        // Only what a peer can use: never the device of this machine.
        s->write(static_cast<Ice::Short>(o_.serial.target));
        s->write(static_cast<Ice::Byte>(o_.channel));
        s->write(o_.timeoutMs);
    }
    Ice::EndpointInfoPtr getInfo() const ICE_NOEXCEPT override {
        typedef IceInternal::InfoI<Ice::EndpointInfo> Info;
        return ICE_MAKE_SHARED(Info, ICE_SHARED_FROM_CONST_THIS(Endpoint));
    }
    Ice::Short type() const override {
        return endpointType;
    }
    const string& protocol() const override {
        return protocolName;
    }
    Ice::Int timeout() const override {
        return o_.timeoutMs;
    }
    EndpointIPtr timeout(Ice::Int ms) const override {
        return with([&](Options& o) { o.timeoutMs = ms; });
    }
    const string& connectionId() const override {
        return o_.connectionId;
    }
    EndpointIPtr connectionId(const string& id) const override {
        return with([&](Options& o) { o.connectionId = id; });
    }
    bool compress() const override {
        return o_.compress;
    }
    EndpointIPtr compress(bool on) const override {
        return with([&](Options& o) { o.compress = on; });
    }
    bool datagram() const override {
        return false;
    }
    bool secure() const override {
        return false;
    }
    IceInternal::TransceiverPtr transceiver() const override {
        return ICE_NULLPTR;
    }
    void connectors_async(Ice::EndpointSelectionType,
                          const IceInternal::EndpointI_connectorsPtr& callback) const override {
        vector<IceInternal::ConnectorPtr> list;
        list.push_back(new Connector(instance_, o_));
        callback->connectors(list);
    }
    IceInternal::AcceptorPtr acceptor(const string&) const override {
        // What listens here is reached at this side's own address: so it is published, and so a
        // proxy to the peer on the same device is not taken for an object of this process.
        return new Acceptor(instance_, o_,
                            with([](Options& o) { o.serial.target = o.serial.source; }));
    }
    vector<EndpointIPtr> expandIfWildcard() const override {
        return only();
    }
    vector<EndpointIPtr> expandHost(EndpointIPtr&) const override {
        return only();
    }
    bool equivalent(const EndpointIPtr& other) const override {
        const Endpoint* o = dynamic_cast<const Endpoint*>(other.get());
        return o && o->o_.serial.device == o_.serial.device && o->o_.channel == o_.channel &&
               o->o_.serial.target == o_.serial.target;
    }
#ifdef ICE_CPP11_MAPPING
    bool operator==(const Ice::Endpoint& other) const override {
        return equals(dynamic_cast<const Endpoint*>(&other));
    }
    bool operator<(const Ice::Endpoint& other) const override {
        return less(dynamic_cast<const Endpoint*>(&other));
    }
#else
    bool operator==(const Ice::LocalObject& other) const override {
        return equals(dynamic_cast<const Endpoint*>(&other));
    }
    bool operator<(const Ice::LocalObject& other) const override {
        return less(dynamic_cast<const Endpoint*>(&other));
    }
#endif
    Ice::Int hash() const override {
        return static_cast<Ice::Int>(std::hash<string>()(key()));
    }
    string options() const override {
        ostringstream s;
        if (!o_.serial.device.empty())
            s << " -d " << quoted(o_.serial.device) << " -b " << o_.serial.baud;
        s << " -a 0x" << hex << o_.serial.target << dec;
        if (!o_.serial.device.empty())
            s << " -s 0x" << hex << o_.serial.source << " -c 0x" << o_.serial.rfChannel << " -i 0x"
              << o_.serial.pan << dec << " -g " << o_.serial.guardMs;
        if (o_.channel != 255)
            s << " -p " << o_.channel;
        s << " -t " << o_.timeoutMs;
        if (o_.compress)
            s << " -z";
        return s.str();
    }

protected:
    bool checkOption(const string& option, const string& argument,
                     const string& endpoint) override {
        if (option == "-z") {
            o_.compress = true;
            return true;
        }
        if (string("-d-b-a-s-c-i-p-t-g-k-h").find(option) == string::npos || option.size() != 2)
            return false;
        if (argument.empty())
            throw Ice::EndpointParseException(__FILE__, __LINE__,
                                              "no argument for option '" + option +
                                                  "' in endpoint '" + endpoint + "'");
        if (option == "-d")
            o_.serial.device = argument;
        else if (option == "-k") { // a secret: it is never printed
            checkKey(argument, "an xbee-at endpoint");
            o_.serial.key = argument;
        } else if (option != "-h") // tolerated: there is no host
            number(option[1], argument, endpoint);
        return true;
    }

private:
    void number(char option, const string& argument, const string& endpoint) {
        char* end = nullptr;
        long value = strtol(argument.c_str(), &end, 0);
        long most = option == 'b'   ? 250000
                    : option == 't' ? 0x7FFFFFFF
                    : option == 'p' ? 2
                                    : 0xFFFF;
        if (*end || value < 0 || value > most)
            throw Ice::EndpointParseException(
                __FILE__, __LINE__,
                string("'") + argument + "' is no value for option '-" + option +
                    "' in endpoint '" + endpoint + "' (0.." + to_string(most) + ")");
        int v = static_cast<int>(value);
        switch (option) {
        case 'b':
            o_.serial.baud = v;
            break;
        case 'a':
            o_.serial.target = v;
            break;
        case 's':
            o_.serial.source = v;
            break;
        case 'c':
            o_.serial.rfChannel = v;
            break;
        case 'i':
            o_.serial.pan = v;
            break;
        case 'p':
            o_.channel = v;
            break;
        case 'g':
            o_.serial.guardMs = v;
            break;
        default:
            o_.timeoutMs = v;
            break;
        }
    }
    static string quoted(const string& s) {
        return s.find_first_of(" :@\t") == string::npos ? s : '"' + s + '"';
    }
    template <class Change> EndpointIPtr with(Change change) const {
        Options o = o_;
        change(o);
        return ICE_MAKE_SHARED(Endpoint, instance_, o);
    }
    vector<EndpointIPtr> only() const {
        return vector<EndpointIPtr>(1, ICE_SHARED_FROM_CONST_THIS(Endpoint));
    }
    string key() const {
        return options() + " " + o_.connectionId;
    }
    bool equals(const Endpoint* other) const {
        return other && key() == other->key();
    }
    bool less(const Endpoint* other) const {
        return other && key() < other->key();
    }

    InstancePtr instance_;
    Options o_;
};

class Factory : public IceInternal::EndpointFactory {
public:
    explicit Factory(const InstancePtr& instance) : instance_(instance) {}
    Ice::Short type() const override { return endpointType; }
    string protocol() const override { return protocolName; }
    EndpointIPtr create(vector<string>& arguments, bool) const override {
        auto endpoint = ICE_MAKE_SHARED(Endpoint, instance_, instance_->defaults());
        endpoint->initWithOptions(arguments);
        return endpoint;
    }
    EndpointIPtr read(Ice::InputStream* s) const override {
        Options o = instance_->defaults();
        Ice::Short address = 0;
        Ice::Byte channel = 0;
        s->read(address);
        s->read(channel);
        s->read(o.timeoutMs);
        o.serial.target = static_cast<unsigned short>(address);
        o.channel = channel > 2 ? 255 : channel;
        return ICE_MAKE_SHARED(Endpoint, instance_, o);
    }
    void destroy() override {
        if (instance_)
            instance_->destroy();
        instance_ = ICE_NULLPTR;
    }
    IceInternal::EndpointFactoryPtr clone(const IceInternal::ProtocolInstancePtr&) const override {
        return new Factory(instance_);
    }

private:
    InstancePtr instance_;
};

class Plugin : public Ice::Plugin {
public:
    explicit Plugin(const Ice::CommunicatorPtr& communicator) {
        IceInternal::getProtocolPluginFacade(communicator)
            ->addEndpointFactory(new Factory(new Instance(communicator)));
    }
    void initialize() override {}
    void destroy() override {}
};

} // namespace

// Ice.Plugin.XBeeAT=xbeeat:createXBeeAT
extern "C" ICE_DECLSPEC_EXPORT Ice::Plugin* createXBeeAT(const Ice::CommunicatorPtr& communicator,
                                                         const string&, const Ice::StringSeq&) {
    return new Plugin(communicator);
}
