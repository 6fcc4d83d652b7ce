// SPDX-License-Identifier: MIT
//
// gateway_options: parses the gateway's options (CLI11). Keys are read from files, never from
// arguments.

#include "gateway_options.h"
#include "key_file.h"

#include <IceSSL/IceSSL.h>
#include <cctype>
#include <cstdlib>
#include <regex>
#include <sstream>

extern "C" Ice::Plugin* createXBeeAT(const std::shared_ptr<Ice::Communicator>&, const std::string&,
                                     const Ice::StringSeq&);

namespace gateway {

namespace {

// Returns Ice endpoints for an argument, which is HOST:PORT or already consists of endpoints.
std::string given(const std::string& text) {
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
    if (host.front() == '[') { // an IPv6 address in brackets, as in URLs: [::1]:10000
        if (host.back() != ']')
            throw std::runtime_error("'" + text + "': a ] is missing");
        host = host.substr(1, host.size() - 2);
    }
    return "tcp -h \"" + host + "\" -p " + port;
}

// Reads the modem's key from a file. An argument would show it to every user of the machine.
std::string readModemKey(const std::string& path) {
    std::string key = XBeeAT::readSecret(path);
    key.erase(key.find_last_not_of(" \n") + 1);
    if (key.empty() || key.size() > 32 ||
        key.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
        throw std::runtime_error("the modem's AES key in '" + path +
                                 "' must be 1 to 32 hexadecimal digits");
    return key;
}

} // namespace

void addOptions(CLI::App& app, Options& o) {
    app.add_option("-d,--device", o.device, "serial port of the modem")->required();
    app.add_option("-b,--baud", o.baud, "baud rate (115200 is the modem's BD 7)")
        ->check(CLI::IsMember({1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200, 250000}));
    const auto one = app.add_option("-a,--address", o.target, "the UAV's 16-bit address")
                         ->check(CLI::Range(0, 0xFFFE));
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
                 "no modems: the port is wired to the vehicle's board, and its jumper PB1 is set");
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
                   "HOST:PORT, or Ice's endpoints: the only ones at which objects for maintenance, "
                   "such as 'keys', 'update' and 'fpga', can be reached");
    app.add_option("--page", o.page,
                   "HOST:PORT of a web page with forms for all operations, opened by this HOST. "
                   "Browsers call a ws endpoint, or wss with IceSSL.CertFile; without one in "
                   "--listen, it is added");
    app.add_option("--origin", o.origins,
                   "origin of another page whose browsers may call, such as "
                   "https://example.org:8443");
    app.add_option("--rights", o.rights,
                   "JSON file: which certificate may call which identities and operations");
    app.add_option("--wait", o.wait,
                   "seconds that a call waits for the radio, and then for the vehicle to take it; "
                   "then it fails")
        ->check(CLI::Range(1, 3600));
    app.add_option("-t,--trace", o.trace, "0 errors, 1 link and connections, 2 AT commands")
        ->check(CLI::Range(0, 2));
    app.footer("Properties of Ice are also options, e.g. --IceSSL.CertFile=gateway.p12. With "
               "--Ice.Default.Locator\neach vehicle is in IceGrid's registry by its name, uav1 for "
               "address 1, while it is here.");
}

void setProperties(const std::shared_ptr<Ice::Properties>& p, const Options& o) {
    const auto preset = [&p](const std::string& name, const std::string& value) {
        if (p->getProperty(name).empty())
            p->setProperty(name, value);
    };
    preset("Ice.ThreadPool.Server.Size", "4");
    preset("Ice.ThreadPool.Server.SizeMax",
           "256"); // a client that waits for room holds a thread
    preset("Ice.ThreadPool.Server.Serialize", "1");
    preset("Ice.ThreadPool.Client.Size", "4");
    preset("Ice.ACM.Client.Close", "0"); // never close: the vehicle may call back at any time
    // always send heartbeats: Ice 3.8 closes the connection of a silent peer after 60 s
    preset("Ice.ACM.Server.Heartbeat", "3");
    preset("Ice.RetryIntervals", "-1");
    preset("Ice.Override.CloseTimeout", "5000");
    preset("Ice.Warn.Connections", "0");
    preset("Ice.Warn.Dispatch", "0");
    preset("XBeeAT.Statistics", "1");
    preset("XBeeAT.Trace", std::to_string(o.trace));
    p->setProperty("XBeeAT.Setup", o.setUp ? "1" : "0");
    p->setProperty("XBeeAT.Api", o.isApi ? "1" : "0");
    p->setProperty("XBeeAT.KeyFile", o.keyFile);
    // connecting includes the set-up of the modem
    p->setProperty("Ice.Override.ConnectTimeout", "30000");
    if (!o.modemKeyFile.empty())
        p->setProperty("XBeeAT.ModemKey", readModemKey(o.modemKeyFile));
    Ice::registerPluginFactory("XBeeAT", createXBeeAT, true);
    if ((o.listen + o.maintenance).find("ssl ") != std::string::npos ||
        (o.listen + o.maintenance).find("wss ") != std::string::npos ||
        (!o.page.empty() && !p->getProperty("IceSSL.CertFile").empty()))
        Ice::registerIceSSL();
}

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

std::map<std::string, int> fleetOf(const Options& o) {
    std::map<std::string, int> fleet;
    for (const std::string& text : o.vehicles) {
        const size_t equals = text.find('=');
        const std::string name = text.substr(0, equals);
        const std::string number = equals < text.size() ? text.substr(equals + 1) : "";
        char* end = nullptr; // strtol returns the largest long for a number that is too large
        const long address = std::strtol(number.c_str(), &end, 0);
        if (name.empty() || number.empty() || !std::isdigit(number[0]) || address > 0xFFFF || *end)
            throw std::runtime_error("'" + text + "': give NAME=ADDRESS, as uav7=0x0007");
        // calls to all vehicles use a one-way proxy of the plugin's endpoint instead
        // (docs/fleet.md)
        if (address == XBeeAT::everybody)
            throw std::runtime_error("'" + text + "': 0xFFFF is all vehicles, give each its own");
        for (const auto& [other, taken] : fleet)
            if (taken == address && other != name)
                throw std::runtime_error("'" + text + "': '" + other + "' has this address");
        if (!fleet.emplace(name, int(address)).second)
            throw std::runtime_error("'" + name + "' is the name of two vehicles");
    }
    if (fleet.empty())
        fleet["uav" + std::to_string(o.target)] = o.target;
    return fleet;
}

std::string endpointsOf(const std::string& text, int place) {
    const std::string endpoints = given(text);
    static const std::regex port(R"(-p ([1-9]\d*))");
    std::string above;
    std::smatch at;
    auto from = endpoints.begin();
    for (; std::regex_search(from, endpoints.end(), at, port); from = at.suffix().first)
        above += at.prefix().str() + "-p " + std::to_string(std::stoi(at[1]) + place);
    return above + std::string(from, endpoints.end());
}

} // namespace gateway
