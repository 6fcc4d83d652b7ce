// SPDX-License-Identifier: MIT
//
// xbee_plugin: the xbee-at transport of ZeroC Ice 3.7: the endpoint, its options as text and on the
// wire, and the factory of endpoints. The file is compiled twice: as a library for the C++98
// mapping, which Python also uses, and as a library for the C++11 mapping. The libraries are linked
// with ZeroC Ice, which is GPL-2.0.

#include "plugin_connection.h"

#include <Ice/EndpointFactory.h>
#include <Ice/ProtocolPluginFacade.h>
#include <cstdlib>
#include <map>
#include <sstream>

namespace XBeeAT {
namespace {

class Endpoint : public IceInternal::EndpointI
#ifdef ICE_CPP11_MAPPING
    ,
                 public std::enable_shared_from_this<Endpoint>
#endif
{
public:
    Endpoint(const InstancePtr& instance, const EndpointOptions& options)
        : instance_(instance), o_(options) {}

    void streamWriteImpl(Ice::OutputStream* s) const override {
        // A proxy contains only the options that a peer can use. A peer cannot use the name of this
        // machine's serial device.
        s->write(static_cast<Ice::Short>(o_.serial.target));
        s->write(static_cast<Ice::Byte>(o_.channel));
        s->write(o_.timeoutMs);
    }
    Ice::EndpointInfoPtr getInfo() const ICE_NOEXCEPT override {
        typedef IceInternal::InfoI<Ice::EndpointInfo> Info;
        return ICE_MAKE_SHARED(Info, ICE_SHARED_FROM_CONST_THIS(Endpoint));
    }
    Ice::Short type() const override { return endpointType; }
    const std::string& protocol() const override {
        return o_.serial.isWire ? wireName : protocolName;
    }
    Ice::Int timeout() const override { return o_.timeoutMs; }
    EndpointIPtr timeout(Ice::Int ms) const override {
        return with([&](EndpointOptions& o) { o.timeoutMs = ms; });
    }
    const std::string& connectionId() const override { return o_.connectionId; }
    EndpointIPtr connectionId(const std::string& id) const override {
        return with([&](EndpointOptions& o) { o.connectionId = id; });
    }
    bool compress() const override { return o_.compress; }
    EndpointIPtr compress(bool on) const override {
        return with([&](EndpointOptions& o) { o.compress = on; });
    }
    bool datagram() const override { return false; }
    bool secure() const override { return false; }
    IceInternal::TransceiverPtr transceiver() const override { return ICE_NULLPTR; }
    void connectors_async(Ice::EndpointSelectionType,
                          const IceInternal::EndpointI_connectorsPtr& callback) const override {
        std::vector<IceInternal::ConnectorPtr> list;
        list.push_back(new Connector(instance_, o_));
        callback->connectors(list);
    }
    IceInternal::AcceptorPtr acceptor(const std::string&) const override {
        // The acceptor's endpoint contains the address of this side. If it contained the peer's
        // address, Ice would mistake a proxy to the peer on the same device for a proxy to an
        // object of this process.
        return new Acceptor(instance_, o_,
                            with([](EndpointOptions& o) { o.serial.target = o.serial.source; }));
    }
    std::vector<EndpointIPtr> expandIfWildcard() const override { return only(); }
    std::vector<EndpointIPtr> expandHost(EndpointIPtr&) const override { return only(); }
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
        return static_cast<Ice::Int>(std::hash<std::string>()(key()));
    }
    std::string options() const override {
        std::ostringstream s;
        if (!o_.serial.device.empty())
            s << " -d " << quoted(o_.serial.device) << " -b " << o_.serial.baud;
        s << " -a 0x" << std::hex << o_.serial.target << std::dec;
        if (!o_.serial.device.empty())
            s << " -s 0x" << std::hex << o_.serial.source << std::dec;
        if (!o_.serial.device.empty() && !o_.serial.isWire)
            s << " -c 0x" << std::hex << o_.serial.rfChannel << " -i 0x" << o_.serial.pan
              << std::dec << " -g " << o_.serial.guardMs;
        if (o_.channel != 255)
            s << " -p " << o_.channel;
        s << " -t " << o_.timeoutMs;
        if (o_.compress)
            s << " -z";
        return s.str();
    }

protected:
    bool checkOption(const std::string& option, const std::string& argument,
                     const std::string& endpoint) override {
        if (option == "-z") {
            o_.compress = true;
            return true;
        }
        if (std::string("-d-b-a-s-c-i-p-t-g-k-h").find(option) == std::string::npos ||
            option.size() != 2)
            return false;
        if (o_.serial.isWire && std::string("-c-i-g-k").find(option) != std::string::npos)
            return false;
        if (argument.empty())
            throw Ice::EndpointParseException(__FILE__, __LINE__,
                                              "endpoint '" + endpoint + "': option '" + option +
                                                  "' needs a value");
        if (option == "-d")
            o_.serial.device = argument;
        else if (option == "-k") { // the key is secret, so the message does not repeat it
            checkModemKey(argument, "an xbee-at endpoint");
            o_.serial.modemKey = argument;
        } else if (option != "-h") // -h is accepted and ignored, because a radio has no host
            number(option[1], argument, endpoint);
        return true;
    }

private:
    void number(char option, const std::string& argument, const std::string& endpoint) {
        char* end = nullptr;
        long value = strtol(argument.c_str(), &end, 0);
        long most = option == 'b'   ? 250000
                    : option == 't' ? 0x7FFFFFFF
                    : option == 'p' ? 2
                                    : 0xFFFF;
        if (*end || value < 0 || value > most)
            throw Ice::EndpointParseException(__FILE__, __LINE__,
                                              "endpoint '" + endpoint + "': -" + option +
                                                  ": expected 0 to " + std::to_string(most) +
                                                  ", got '" + argument + "'");
        static const std::map<char, int Settings::*> ofSerial = {
            {'b', &Settings::baud},      {'a', &Settings::target}, {'s', &Settings::source},
            {'c', &Settings::rfChannel}, {'i', &Settings::pan},    {'g', &Settings::guardMs}};
        const auto found = ofSerial.find(option);
        int& field = found != ofSerial.end() ? o_.serial.*found->second
                     : option == 'p'         ? o_.channel
                                             : o_.timeoutMs;
        field = static_cast<int>(value);
    }
    static std::string quoted(const std::string& s) {
        return s.find_first_of(" :@\t") == std::string::npos ? s : '"' + s + '"';
    }
    template <class Change> EndpointIPtr with(Change change) const {
        EndpointOptions o = o_;
        change(o);
        return ICE_MAKE_SHARED(Endpoint, instance_, o);
    }
    std::vector<EndpointIPtr> only() const {
        return std::vector<EndpointIPtr>(1, ICE_SHARED_FROM_CONST_THIS(Endpoint));
    }
    std::string key() const { return options() + " " + o_.connectionId; }
    bool equals(const Endpoint* other) const { return other && key() == other->key(); }
    bool less(const Endpoint* other) const { return other && key() < other->key(); }

    InstancePtr instance_;
    EndpointOptions o_;
};

// Creates the endpoints of one of the two protocols.
class Factory : public IceInternal::EndpointFactory {
public:
    Factory(const InstancePtr& instance, bool isWire) : instance_(instance), isWire_(isWire) {}
    Ice::Short type() const override { return isWire_ ? wireType : endpointType; }
    std::string protocol() const override { return isWire_ ? wireName : protocolName; }
    EndpointIPtr create(std::vector<std::string>& arguments, bool) const override {
        EndpointOptions o = instance_->defaults();
        o.serial.isWire = isWire_;
        o.serial.setUp = o.serial.setUp && !isWire_;
        auto endpoint = ICE_MAKE_SHARED(Endpoint, instance_, o);
        endpoint->initWithOptions(arguments);
        return endpoint;
    }
    EndpointIPtr read(Ice::InputStream* s) const override {
        EndpointOptions o = instance_->defaults();
        Ice::Short address = 0;
        Ice::Byte channel = 0;
        s->read(address);
        s->read(channel);
        s->read(o.timeoutMs);
        o.serial.target = static_cast<unsigned short>(address);
        o.channel = channel > 2 ? 255 : channel;
        return ICE_MAKE_SHARED(Endpoint, instance_, o);
    }
    // Keeps the instance, because another thread may still be parsing a proxy. The instance refuses
    // further connections.
    void destroy() override { instance_->destroy(); }
    IceInternal::EndpointFactoryPtr clone(const IceInternal::ProtocolInstancePtr&) const override {
        return new Factory(instance_, isWire_);
    }

private:
    InstancePtr instance_;
    const bool isWire_;
};

class Plugin : public Ice::Plugin {
public:
    explicit Plugin(const Ice::CommunicatorPtr& communicator) {
        const InstancePtr instance = new Instance(communicator);
        for (bool isWire : {false, true})
            IceInternal::getProtocolPluginFacade(communicator)
                ->addEndpointFactory(new Factory(instance, isWire));
    }
    void initialize() override {}
    void destroy() override {}
};

} // namespace
} // namespace XBeeAT

// Ice.Plugin.XBeeAT=xbeeat:createXBeeAT
extern "C" ICE_DECLSPEC_EXPORT Ice::Plugin*
createXBeeAT(const Ice::CommunicatorPtr& communicator, const std::string&, const Ice::StringSeq&) {
    return new XBeeAT::Plugin(communicator);
}
