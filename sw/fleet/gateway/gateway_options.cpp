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

// Returns Ice endpoints for an argument. The argument is HOST:PORT, or is an endpoint already.
std::string given(const std::string& text) {
    if (text.find(' ') != std::string::npos)
        return text;
    const size_t colon = text.rfind(':');
    if (colon == std::string::npos || colon == 0)
        throw std::runtime_error(
            "'" + text + "': expected HOST:PORT, or Ice endpoints such as \"ssl -p 10001\"");
    const std::string port = text.substr(colon + 1);
    if (port.empty() || port.find_first_not_of("0123456789") != std::string::npos ||
        port.size() > 5 || std::stoul(port) > 65535)
        throw std::runtime_error("'" + text + "': expected a port of 0 to 65535");
    std::string host = text.substr(0, colon);
    if (host.front() == '[') { // an IPv6 address in brackets, as in URLs: [::1]:10000
        if (host.back() != ']')
            throw std::runtime_error("'" + text + "': expected ] after the IPv6 address");
        host = host.substr(1, host.size() - 2);
    }
    return "tcp -h \"" + host + "\" -p " + port;
}

// Reads the modem's key from a file. On the command line, every user of the machine could see the
// key.
std::string readModemKey(const std::string& path) {
    std::string key = XBeeAT::readSecret(path);
    key.erase(key.find_last_not_of(" \r\n") + 1);
    const std::string mark = "\xEF\xBB\xBF"; // byte order mark that some editors write
    if (key.compare(0, mark.size(), mark) == 0)
        key.erase(0, mark.size());
    if (key.empty() || key.size() > 32 ||
        key.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
        throw std::runtime_error("modem key file '" + path +
                                 "': expected 1 to 32 hexadecimal digits");
    return key;
}

} // namespace

void addOptions(CLI::App& app, Options& o) {
    app.add_option("-d,--device", o.device, "serial port of the modem; must be given");
    app.add_option(
           "-b,--baud", o.baud,
           "baud rate of the modem (default 115200, the modem's BD 7, whose real rate is 111,111)")
        ->check(CLI::IsMember({1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200, 250000}));
    const auto one = app.add_option("-a,--address", o.target,
                                    "16-bit address of the only vehicle (default 0x0001)")
                         ->check(CLI::Range(0, 0xFFFE));
    app.add_option("--vehicle", o.vehicles,
                   "NAME=ADDRESS of a vehicle, such as uav7=0x0007; repeat the option for several "
                   "vehicles. In alphabetical order of the names, the first vehicle gets the port "
                   "of --listen, and each further vehicle the next port")
        ->excludes(one);
    app.add_option("-s,--source", o.source,
                   "16-bit address of this ground station (default 0x0000)")
        ->check(CLI::Range(0, 0xFFFF));
    app.add_option("-c,--channel", o.rfChannel, "RF channel (default 12)")
        ->check(CLI::Range(0x0B, 0x1A));
    app.add_option("-i,--pan", o.pan, "network id of the modems (default 0x3332)")
        ->check(CLI::Range(0, 0xFFFF));
    app.add_option("--key", o.keyFile,
                   "file (mode 0600) with the vehicle's key, 32 hexadecimal digits, or with a line "
                   "\"0x0001 KEY\" for each vehicle; /dev/fd/3 reads descriptor 3 (default: "
                   "no key, unencrypted)");
    app.add_option("--modem-key", o.modemKeyFile,
                   "file (mode 0600) with the AES key of the modems, 1 to 32 hexadecimal digits "
                   "(default: the modem's setting is not changed)");
    app.add_option("-g,--guard", o.guardMs, "current guard time of the modem, ms (default 1000)")
        ->check(CLI::Range(2, 3300));
    app.add_flag("!--no-setup", o.setUp, "do not configure the modem: it is already configured");
    app.add_flag("!--transparent", o.isApi, "use the modem in transparent mode, not in API mode");
    app.add_flag("--wire", o.isWire,
                 "the serial port is wired to the vehicle's board, without modems; the board's "
                 "jumper PB1 must be closed");
    app.add_option("-l,--listen", o.listen,
                   "HOST:PORT at which clients connect, or Ice endpoints such as \"ssl -p 10001\". "
                   "An IPv6 address is written as [::1]:PORT; port 0 selects a free port, which is "
                   "printed (default 127.0.0.1:10000)");
    const auto station = app.add_option(
        "--station", o.station,
        "HOST:PORT, or Ice endpoints, of the server that the vehicle calls (default: none)");
    app.add_option("--topics", o.topics,
                   "proxy of IceStorm's topic manager; the vehicles' calls, and messages about "
                   "vehicles that arrive and leave, are published under the topic 'vehicles'")
        ->excludes(station);
    app.add_option("--maintenance", o.maintenance,
                   "HOST:PORT, or Ice endpoints, for maintenance objects such as 'keys', 'update' "
                   "and 'fpga', which accept calls only at this endpoint (default: none)");
    app.add_option("--page", o.page,
                   "HOST:PORT of a web page with forms for all operations. Open it under exactly "
                   "this HOST. Browsers make calls to a ws endpoint (wss with IceSSL.CertFile); if "
                   "--listen has no such endpoint, one is added");
    app.add_option("--origin", o.origins,
                   "origin of another web page that may make calls, such as "
                   "https://example.org:8443");
    app.add_option("--rights", o.rights,
                   "JSON file with rules that define which certificates may call which objects and "
                   "operations (default: every client may call everything)");
    app.add_option(
           "--wait", o.wait,
           "limit of each of the two waits of a call, s (default 30): until the radio is free, and "
           "then until the vehicle has received the call")
        ->check(CLI::Range(1, 3600));
    app.add_option("--end", o.end,
                   "limit for the end after a signal, s (default 20), if the connection of a "
                   "client does not end")
        ->check(CLI::Range(1, 3600));
    app.add_option(
           "-t,--trace", o.trace,
           "messages to print: 0 errors (default); 1 also messages about link and connections; "
           "2 also AT commands")
        ->check(CLI::Range(0, 2));
    app.footer(
        "Ice properties are also options, such as --IceSSL.CertFile=gateway.p12. With\n"
        "--Ice.Default.Locator each vehicle is registered in IceGrid under its name (uav1 for\n"
        "address 1) while it is connected to this ground station.\n"
        "\n"
        "examples:\n"
        "  icesoc-gateway -d /dev/ttyUSB0 --key uav1.key\n"
        "  icesoc-gateway -d /dev/ttyUSB0 --key fleet.keys --vehicle uav7=0x0007 --vehicle "
        "uav8=0x0008\n"
        "  icesoc-gateway -d /dev/ttyUSB0 --key uav1.key --station 127.0.0.1:10100 --page "
        "127.0.0.1:8080");
}

void setProperties(const std::shared_ptr<Ice::Properties>& p, const Options& o) {
    const auto preset = [&p](const std::string& name, const std::string& value) {
        if (p->getProperty(name).empty())
            p->setProperty(name, value);
    };
    preset("Ice.ThreadPool.Server.Size", "4");
    preset("Ice.ThreadPool.Server.SizeMax",
           // Many threads, because each client that waits for room in the queue blocks one of them.
           "256");
    preset("Ice.ThreadPool.Server.Serialize", "1");
    preset("Ice.ThreadPool.Client.Size", "4");
    // 0: never closes idle connections, because the vehicle may call back at any time
    preset("Ice.ACM.Client.Close", "0");
    // 3: always sends heartbeats, because Ice 3.8 closes a connection on which it receives nothing
    // for 60 s
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
    // connecting takes long, because it includes the set-up of the modem
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
        char* end = nullptr; // strtol returns the largest long if the number is too large
        const long address = std::strtol(number.c_str(), &end, 0);
        if (name.empty() || number.empty() || !std::isdigit(number[0]) || address > 0xFFFF || *end)
            throw std::runtime_error("--vehicle: expected NAME=ADDRESS such as uav7=0x0007, got '" +
                                     text + "'");
        // no vehicle may have the address for calls to all vehicles; such calls use a one-way
        // proxy with the plugin's endpoint (docs/fleet.md)
        if (address == XBeeAT::everybody)
            throw std::runtime_error(
                "--vehicle " + text +
                ": 0xFFFF means all vehicles; expected the address of one vehicle");
        for (const auto& [other, taken] : fleet)
            if (taken == address && other != name)
                throw std::runtime_error("--vehicle " + text + ": vehicle '" + other +
                                         "' already has this address");
        if (!fleet.emplace(name, int(address)).second)
            throw std::runtime_error("--vehicle: duplicate name '" + name + "'");
    }
    if (fleet.empty())
        fleet["uav" + std::to_string(o.target)] = o.target;
    return fleet;
}

std::string endpointsOf(const std::string& text, int place) {
    const std::string endpoints = given(text);
    // A number with more digits is not a port; Ice then reports it.
    static const std::regex port(R"(-p ([1-9]\d{0,4})(?!\d))");
    std::string above;
    std::smatch at;
    auto from = endpoints.begin();
    for (; std::regex_search(from, endpoints.end(), at, port); from = at.suffix().first)
        above += at.prefix().str() + "-p " + std::to_string(std::stoi(at[1]) + place);
    return above + std::string(from, endpoints.end());
}

} // namespace gateway
