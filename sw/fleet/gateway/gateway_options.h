// SPDX-License-Identifier: MIT
//
// gateway_options: the gateway's options, and the properties and endpoints that they set in Ice.

#pragma once

#include <CLI/CLI.hpp>
#include <Ice/Ice.h>
#include <map>
#include <string>
#include <vector>

namespace gateway {

struct Options {
    std::string device, keyFile, modemKeyFile, rights, station, maintenance, topics, page;
    std::vector<std::string> vehicles; // vehicles, each as NAME=ADDRESS
    std::vector<std::string> origins;  // origins of other web pages that may call
    std::string listen = "127.0.0.1:10000";
    int baud = 115200, target = 1, source = 0, rfChannel = 0x0C, pan = 0x3332, guardMs = 1000;
    int trace = 0, wait = 30;
    bool setUp = true, isApi = true, isWire = false;
};

void addOptions(CLI::App& app, Options& o);
// Sets Ice's properties, including the radio's, unless the command line sets them.
void setProperties(const std::shared_ptr<Ice::Properties>& p, const Options& o);

// Returns the vehicles' names and addresses. Throws if a name or an address is not valid.
std::map<std::string, int> fleetOf(const Options& o);
// Returns the endpoint, at the serial port, for the vehicle and for its calls.
std::string radioEndpoint(const Options& o, int address);
// Returns Ice endpoints for "HOST:PORT" or "[::1]:PORT", or for text that already is an endpoint.
// Ports are increased by `place`; port 0 (any) stays 0.
std::string endpointsOf(const std::string& text, int place = 0);

} // namespace gateway
