// SPDX-License-Identifier: MIT
//
// gateway_options: the command-line options of the gateway, and the Ice properties and endpoints
// that result from them.

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
    // origins of other web pages that may call through the gateway
    std::vector<std::string> origins;
    std::string listen = "127.0.0.1:10000";
    int baud = 115200, target = 1, source = 0, rfChannel = 0x0C, pan = 0x3332, guardMs = 1000;
    int trace = 0, wait = 30, end = 20;
    bool setUp = true, isApi = true, isWire = false;
};

void addOptions(CLI::App& app, Options& o);
// Sets the properties of Ice and of the radio plugin, except those that the command line sets.
void setProperties(const std::shared_ptr<Ice::Properties>& p, const Options& o);

// Returns the address of each vehicle by its name. Throws an exception if a name or an
// address is not valid.
std::map<std::string, int> fleetOf(const Options& o);
// Returns the endpoint of a vehicle on the radio. A proxy with this endpoint reaches the vehicle;
// an adapter with this endpoint receives the vehicle's calls.
std::string radioEndpoint(const Options& o, int address);
// Returns Ice endpoints for "HOST:PORT" or "[::1]:PORT", or for a text that already consists of
// endpoints. Adds `place` to each port; port 0 (any free port) stays 0.
std::string endpointsOf(const std::string& text, int place = 0);

} // namespace gateway
