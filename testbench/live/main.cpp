// SPDX-License-Identifier: MIT
//
// icesoc-live: serves the page of a mission on the loopback interface, and nothing else anywhere.

#include "live_state.h"
#include <CLI/CLI.hpp>
#include <csignal>
#include <fstream>
#include <httplib.h>
#include <iostream>
#include <sstream>

namespace {
httplib::Server* running = nullptr;
constexpr size_t mostConnections = 128;
} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Serves the page that shows a mission as it runs, on 127.0.0.1."};
    std::string dir, registers;
    int port = 0;
    app.add_option("--dir", dir, "the mission's folder: status, calls.jsonl, before.png")
        ->required();
    app.add_option("--registers", registers, "file that lists the blocks' *.regs.json")->required();
    app.add_option("--port", port, "0: any that is free")->check(CLI::Range(0, 65535));
    CLI11_PARSE(app, argc, argv);
    try {
        LiveState state(dir, registers);
        httplib::Server server;
        server.set_mount_point("/", PAGE);
        server.Get("/state", [&](const httplib::Request&, httplib::Response& response) {
            response.set_content(state.now().dump(), "application/json");
        });
        server.Get("/frame.png", [&](const httplib::Request&, httplib::Response& response) {
            std::ifstream file(dir + "/before.png", std::ios::binary);
            std::ostringstream bytes;
            bytes << file.rdbuf();
            response.status = file ? 200 : 404;
            response.set_content(bytes.str(), "image/png");
        });
        // A connection is a thread, one request long; one that says nothing for a second is closed.
        server.new_task_queue = [] { return new httplib::ThreadPool(mostConnections); };
        server.set_keep_alive_max_count(1);
        server.set_keep_alive_timeout(1);
        server.set_read_timeout(1);
        server.set_write_timeout(1);
        server.set_payload_max_length(0);
        // The handler refuses pages of other hosts that have this address by another name, and
        // headers of ranges: no part of a file is worth one.
        server.set_pre_routing_handler(
            [&](const httplib::Request& request, httplib::Response& response) {
                const std::string at = request.get_header_value("Host");
                const std::string number = ":" + std::to_string(port);
                const bool isOurs = at == "127.0.0.1" + number || at == "localhost" + number;
                if (isOurs && !request.has_header("Range"))
                    return httplib::Server::HandlerResponse::Unhandled;
                response.status = isOurs ? 416 : 403;
                return httplib::Server::HandlerResponse::Handled;
            });
        // The library's default, SO_REUSEPORT, would let two pages have one port.
        server.set_socket_options([](socket_t socket) {
            int yes = 1;
            setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        });
        const char* host = "127.0.0.1";
        if (port == 0)
            port = server.bind_to_any_port(host);
        else if (!server.bind_to_port(host, port))
            port = -1;
        if (port < 0)
            throw std::runtime_error(
                "cannot listen on 127.0.0.1: is the port taken? PORT=0 takes any that is free");
        std::cout << "The mission as it runs: http://127.0.0.1:" << port << "/" << std::endl;
        running = &server;
        for (int signal : {SIGINT, SIGTERM})
            std::signal(signal, [](int) { running->stop(); });
        server.listen_after_bind();
        return 0;
    } catch (const std::exception& e) {
        std::cerr << "icesoc-live: error: " << e.what() << "\n";
        return 1;
    }
}
