// SPDX-License-Identifier: MIT
//
// page_server: HTTP for one page, on the loopback interface: GET of the names that it is given, one
// request a connection. One thread serves all; a client that is slow, silent or endless costs a
// place and a head of memory, for ten seconds at most, and none of the others waits for it.

#ifndef PAGE_SERVER_H
#define PAGE_SERVER_H

#include <chrono>
#include <csignal>
#include <functional>
#include <list>
#include <map>
#include <string>

// The paths that can be got, with their content.
class Pages {
public:
    using Content = std::function<std::string()>; // empty: not there yet

    // Gives `path` its content, of a MIME type.
    void add(const std::string& path, const std::string& type, Content content);
    // Returns the answer to a request, from its first line to the empty one, at this port. Who
    // names this address otherwise than we do is refused (403): a page of another host may have it
    // by another name.
    std::string answer(const std::string& head, int port) const;

private:
    struct Page {
        std::string type;
        Content content;
    };
    std::map<std::string, Page> pages_;
};

class PageServer {
public:
    // Listens on 127.0.0.1; port 0 is any that is free. Throws std::runtime_error where it is
    // taken.
    PageServer(const Pages& pages, int port);
    ~PageServer();
    PageServer(const PageServer&) = delete;
    PageServer& operator=(const PageServer&) = delete;

    int port() const { return port_; }
    // Returns soon after a signal has set `stop`.
    void serve(const volatile std::sig_atomic_t& stop);

private:
    using Clock = std::chrono::steady_clock;
    struct Client {
        int fd;
        Clock::time_point end;
        std::string in, out;
    };
    void accept();
    bool goesOn(Client& client) const;

    const Pages& pages_;
    int listener_ = -1, port_ = 0;
    std::list<Client> clients_; // the oldest first
};

#endif
