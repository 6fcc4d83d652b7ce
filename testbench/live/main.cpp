// SPDX-License-Identifier: MIT
//
// icesoc-live: serves the page of a mission on the loopback interface, and nothing else anywhere.

#include "live_state.h"
#include "page_server.h"
#include <CLI/CLI.hpp>
#include <csignal>
#include <iostream>

namespace {
volatile std::sig_atomic_t stopSignal = 0;
}

int main(int argc, char** argv) {
    CLI::App app{"Serves the page that shows a mission as it runs, on 127.0.0.1."};
    std::string dir, registers;
    int port = 0;
    bool onlyTry = false;
    app.add_option("--dir", dir, "the mission's folder: status, calls.jsonl, before.png")
        ->required();
    app.add_option("--registers", registers, "file that lists the blocks' *.regs.json")->required();
    app.add_option("--port", port, "0: any that is free")->check(CLI::Range(0, 65535));
    app.add_flag("--try", onlyTry, "only look whether the page can be served");
    CLI11_PARSE(app, argc, argv);
    for (int signal : {SIGINT, SIGTERM})
        std::signal(signal, [](int number) { stopSignal = number; });
    try {
        LiveState state(dir, registers);
        Pages pages;
        auto add = [&](const char* path, const char* type, const std::string& file) {
            pages.add(path, type, [file] { return contents(file); });
        };
        add("/", "text/html; charset=utf-8", PAGE "/index.html");
        add("/common.css", "text/css", COMMON_PAGE "/common.css");
        add("/common.js", "text/javascript", COMMON_PAGE "/common.js");
        add("/live.css", "text/css", PAGE "/live.css");
        add("/live.js", "text/javascript", PAGE "/live.js");
        add("/frame.png", "image/png", dir + "/before.png");
        pages.add("/state", "application/json", [&] { return state.now(); });
        PageServer server(pages, port);
        if (onlyTry)
            return 0;
        std::cout << "The mission as it runs: http://127.0.0.1:" << server.port() << "/"
                  << std::endl;
        server.serve(stopSignal);
        return 0;
    } catch (const std::exception& e) {
        std::cerr << "icesoc-live: error: " << e.what() << "\n";
        return 1;
    }
}
