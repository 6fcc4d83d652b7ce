// SPDX-License-Identifier: MIT
//
// ping: a short ground station in C++. It prints the type of an object, pings the object, and
// prints the duration of each ping. Usage: ping "hwengine1:xbee-at -d /dev/ttyUSB0 -a 1" [count]

#include <Ice/Ice.h>
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>

#ifndef PLUGIN
// an installed plugin is in the system's library folder, so the name alone is enough
#define PLUGIN "xbeeat"
#endif

// Returns the reason of an error. An Ice exception's message begins with a line that contains a
// position in Ice's source code and the name of a class; the reason follows.
static std::string reasonOf(const std::exception& error) {
    std::string text = error.what();
    if (const auto* ice = dynamic_cast<const Ice::Exception*>(&error)) {
        const size_t end = text.find('\n');
        text = end == std::string::npos ? ice->ice_id().substr(7) : text.substr(end + 1);
    }
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

int main(int argc, char** argv) {
    if (argc < 2 || std::string(argv[1]) == "--help") {
        std::cerr << "usage: ping PROXY [COUNT] [--PROPERTY=VALUE ...]   e.g. ping "
                     "\"hwengine1:xbee-at -d /dev/ttyUSB0 -a 1\" 5 --XBeeAT.Trace=2\n";
        return 2;
    }
    try {
        Ice::InitializationData data;
        data.properties = Ice::createProperties();
        data.properties->setProperty("Ice.Plugin.XBeeAT", PLUGIN ":createXBeeAT");
        data.properties->setProperty("Ice.Default.InvocationTimeout", "300000");
        data.properties->setProperty("Ice.ACM.Close", "0");
        const Ice::StringSeq words =
            data.properties->parseCommandLineOptions("", Ice::StringSeq(argv + 1, argv + argc));
        if (words.empty())
            throw std::runtime_error("expected the proxy of an object; see --help");
        Ice::CommunicatorHolder ic(data);
        auto object = ic->stringToProxy(words[0]);
        std::cout << ic->proxyToString(object) << "\n";
        for (int i = 0, count = words.size() > 1 ? std::atoi(words[1].c_str()) : 3; i < count;
             ++i) {
            auto start = std::chrono::steady_clock::now();
            object->ice_ping();
            std::cout << "ping " << i + 1 << ": "
                      << std::chrono::duration<double, std::milli>(
                             std::chrono::steady_clock::now() - start)
                             .count()
                      << " ms" << std::endl;
        }
        std::cout << "type: " << object->ice_id() << std::endl;
    } catch (const std::exception& e) {
        std::cerr << "ping: " << reasonOf(e) << "\n";
        return 1;
    }
    return 0;
}
