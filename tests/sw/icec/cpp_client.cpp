// SPDX-License-Identifier: MIT
//
// cpp_client: stock ZeroC Ice in C++ (C++11 mapping) against an IceC server on the port given.

#include "Interop.h"
#include <Ice/Ice.h>
#include <iostream>

int main(int argc, char** argv) {
    if (argc != 2)
        return 2;
    Ice::CommunicatorHolder ic(Ice::initialize());
    auto check = [](bool ok, const char* what) {
        if (!ok)
            throw std::runtime_error(what);
    };
    try {
        const std::string where = ":tcp -h 127.0.0.1 -p " + std::string(argv[1]);
        auto service = Ice::checkedCast<Interop::ServicePrx>(ic->stringToProxy("service" + where));
        check(service != nullptr, "checkedCast");
        for (int i = 0; i < 1000; ++i)
            check(service->add(i, i) == 2 * i, "add");
        Interop::Items items = {{"a", 1, Interop::Colour::green, 0.5},
                                {"b", 2, Interop::Colour::blue, -1}};
        std::string joined;
        Interop::Items back = service->reverse(items, joined);
        check(joined == "ab" && back.size() == 2 && back[0].name == "b" && back[1].price == 0.5,
              "reverse");
        Interop::Bytes bytes(8000, 7);
        check(service->echo(bytes) == bytes, "echo");
        service->ice_oneway()->notify("hello");
        check(service->notifications() == 1, "oneway");
        // Several calls in flight on one connection.
        std::vector<std::future<int>> futures;
        for (int i = 0; i < 50; ++i)
            futures.push_back(service->addAsync(i, 1));
        for (int i = 0; i < 50; ++i)
            check(futures[static_cast<size_t>(i)].get() == i + 1, "addAsync");
        try {
            ic->stringToProxy("nobody" + where)->ice_ping();
            check(false, "no ObjectNotExistException");
        } catch (const Ice::ObjectNotExistException&) {
        }
        service->shutdown();
    } catch (const std::exception& e) {
        std::cerr << "cpp_client: " << e.what() << "\n";
        return 1;
    }
    std::cout << "cpp_client: all calls as expected\n";
    return 0;
}
