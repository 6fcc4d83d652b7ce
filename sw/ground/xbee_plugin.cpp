// SPDX-License-Identifier: MIT
//
// xbee_plugin: the xbee-at transport of ZeroC Ice 3.7. One source, two libraries: for the C++98
// mapping (which Python loads) and for the C++11 mapping. It links to ZeroC Ice, which is GPL-2.0.

#include "plugin_endpoint.h"

#include <Ice/ProtocolPluginFacade.h>

namespace {

class Plugin : public Ice::Plugin {
public:
    explicit Plugin(const Ice::CommunicatorPtr& communicator) {
        const XBeeAT::InstancePtr instance = new XBeeAT::Instance(communicator);
        for (bool isWire : {false, true})
            IceInternal::getProtocolPluginFacade(communicator)
                ->addEndpointFactory(new XBeeAT::Factory(instance, isWire));
    }
    void initialize() override {}
    void destroy() override {}
};

} // namespace

// Ice.Plugin.XBeeAT=xbeeat:createXBeeAT
extern "C" ICE_DECLSPEC_EXPORT Ice::Plugin*
createXBeeAT(const Ice::CommunicatorPtr& communicator, const std::string&, const Ice::StringSeq&) {
    return new Plugin(communicator);
}
