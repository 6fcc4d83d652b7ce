// SPDX-License-Identifier: MIT
//
// plugin_instance: what the endpoints of one communicator share: defaults, logger, peers.

#pragma once

#include "engine.h"

#include <Ice/Ice.h>
#include <mutex>
#include <set>
#include <string>
#include <system_error>

namespace XBeeAT {

constexpr Ice::Short endpointType = 0x4158, wireType = 0x4159; // the second never on the air
inline const std::string protocolName = "xbee-at", wireName = "serial";
constexpr Ice::Int defaultTimeoutMs = 30000; // setting a modem up takes seconds

struct EndpointOptions {
    Settings serial;
    int channel = 255; // logical, 255: any
    Ice::Int timeoutMs = defaultTimeoutMs;
    std::string connectionId;
    bool compress = false;
};

// The key is in no message.
inline void checkModemKey(const std::string& key, const std::string& where) {
    if (key.size() > 32 || key.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
        throw Ice::EndpointParseException(
            __FILE__, __LINE__, "the AES key of " + where + " must be up to 32 hexadecimal digits");
}

// Instance holds what the endpoints of one communicator share: its properties and its logger.
class Instance : public IceUtil::Shared {
public:
    explicit Instance(const Ice::CommunicatorPtr& communicator) : communicator_(communicator) {
        Ice::PropertiesPtr p = communicator->getProperties();
        trace_ = p->getPropertyAsInt("XBeeAT.Trace");
        statistics_ = p->getPropertyAsInt("XBeeAT.Statistics") > 0;
        defaults_.serial.device = p->getProperty("XBeeAT.Device");
        defaults_.serial.baud = p->getPropertyAsIntWithDefault("XBeeAT.Baud", 115200);
        defaults_.serial.guardMs = p->getPropertyAsIntWithDefault("XBeeAT.Guard", 1000);
        defaults_.serial.modemKey = p->getProperty("XBeeAT.ModemKey");
        checkModemKey(defaults_.serial.modemKey, "property XBeeAT.ModemKey");
        const std::string keyFile = p->getProperty("XBeeAT.KeyFile");
        try {
            if (!keyFile.empty())
                keys_ = KeyFile(keyFile);
        } catch (const std::runtime_error& e) {
            throw Ice::PluginInitializationException(__FILE__, __LINE__,
                                                     std::string("xbee-at: ") + e.what());
        }
        defaults_.serial.downMs = 1000 * p->getPropertyAsIntWithDefault("XBeeAT.Down", 15);
        defaults_.serial.idleMs = 1000 * p->getPropertyAsIntWithDefault("XBeeAT.Idle", 60);
        defaults_.serial.isApi = p->getPropertyAsIntWithDefault("XBeeAT.Api", 1) > 0;
        defaults_.serial.setUp = p->getPropertyAsIntWithDefault("XBeeAT.Setup", 1) > 0;
    }
    const EndpointOptions& defaults() const { return defaults_; }

    // A thread may ask for a connection while another destroys the communicator.
    std::shared_ptr<Peer> peer(const EndpointOptions& o) {
        std::lock_guard<std::mutex> lock(mutex_);
        if (!communicator_)
            throw Ice::CommunicatorDestroyedException(__FILE__, __LINE__);
        Ice::LoggerPtr logger = communicator_->getLogger();
        int trace = trace_;
        try {
            Settings settings = o.serial;
            settings.keys = keys_.of(settings.target);
            auto peer = Engine::get(settings, [logger, trace](int level, const std::string& text) {
                if (level == 0)
                    logger->error("xbee-at: " + text);
                else if (level <= trace)
                    logger->trace("XBeeAT", text);
            });
            peers_.insert(peer);
            return peer;
        } catch (const std::system_error& e) {
            logger->error(std::string("xbee-at: ") + e.what());
            throw Ice::ConnectFailedException(__FILE__, __LINE__, e.code().value());
        } catch (const std::runtime_error& e) {
            logger->error(std::string("xbee-at: ") + e.what());
            throw Ice::ConnectFailedException(__FILE__, __LINE__, EACCES);
        }
    }
    void destroy() {
        std::lock_guard<std::mutex> lock(mutex_);
        for (const auto& peer : peers_)
            if (statistics_)
                communicator_->getLogger()->print("xbee-at: " + peer->statistics());
        peers_.clear();
        communicator_ = ICE_NULLPTR;
    }

private:
    std::mutex mutex_; // guards communicator_ and peers_
    Ice::CommunicatorPtr communicator_;
    EndpointOptions defaults_;
    KeyFile keys_;
    int trace_ = 0;
    bool statistics_ = false;
    std::set<std::shared_ptr<Peer>> peers_; // kept while the communicator lives: set-up takes time
};
typedef IceUtil::Handle<Instance> InstancePtr;

} // namespace XBeeAT
