// SPDX-License-Identifier: MIT
//
// page_server: as much of HTTP/1.1 (RFC 9112) as a browser needs to GET a page.

#include "page_server.h"
#include <cerrno>
#include <netinet/in.h>
#include <poll.h>
#include <sstream>
#include <stdexcept>
#include <strings.h>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

namespace {

constexpr std::chrono::seconds patience{10};
constexpr size_t longestHead = 8192, mostClients = 128;

std::string response(const std::string& status, const std::string& type,
                     const std::string& content) {
    return "HTTP/1.1 " + status + "\r\nContent-Type: " + type +
           "\r\nContent-Length: " + std::to_string(content.size()) +
           "\r\nConnection: close\r\n\r\n" + content;
}

std::string failure(const std::string& status) {
    return response(status, "text/plain", status + "\n");
}

// The values of all header lines `Host`, one after the other: two are none of ours.
std::string hostOf(std::istream& lines) {
    const std::string name = "host:";
    std::string host;
    for (std::string line; std::getline(lines, line);)
        if (strncasecmp(line.c_str(), name.c_str(), name.size()) == 0)
            for (char c : line.substr(name.size()))
                if (c != ' ' && c != '\t' && c != '\r')
                    host += c;
    return host;
}

bool isLater(ssize_t count) {
    return count < 0 && (errno == EAGAIN || errno == EINTR);
}

} // namespace

void Pages::add(const std::string& path, const std::string& type, Content content) {
    pages_[path] = {type, std::move(content)};
}

std::string Pages::answer(const std::string& head, int port) const {
    std::istringstream lines(head);
    std::string method, target, version;
    lines >> method >> target >> version;
    if (version.rfind("HTTP/1.", 0) != 0)
        return failure("400 Bad Request");
    const std::string host = hostOf(lines), number = ":" + std::to_string(port);
    if (host != "127.0.0.1" + number && host != "localhost" + number)
        return failure("403 Forbidden");
    if (method != "GET")
        return failure("405 Method Not Allowed");
    const auto page = pages_.find(target.substr(0, target.find('?')));
    if (page == pages_.end())
        return failure("404 Not Found");
    const std::string content = page->second.content();
    return content.empty() ? failure("404 Not Found")
                           : response("200 OK", page->second.type, content);
}

PageServer::PageServer(const Pages& pages, int port) : pages_(pages) {
    sockaddr_in at{};
    socklen_t size = sizeof at;
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    at.sin_port = htons(static_cast<uint16_t>(port));
    const int yes = 1;
    listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (listener_ < 0 || bind(listener_, reinterpret_cast<sockaddr*>(&at), size) != 0 ||
        listen(listener_, static_cast<int>(mostClients)) != 0 ||
        getsockname(listener_, reinterpret_cast<sockaddr*>(&at), &size) != 0)
        throw std::runtime_error(
            "cannot listen on 127.0.0.1: is the port taken? PORT=0 takes any that is free");
    port_ = ntohs(at.sin_port);
}

PageServer::~PageServer() {
    for (Client& client : clients_)
        close(client.fd);
    close(listener_);
}

// The one that has been here for longest makes room.
void PageServer::accept() {
    const int fd = accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    const bool isFull = clients_.size() == mostClients || (fd < 0 && !isLater(fd));
    if (isFull && !clients_.empty()) {
        close(clients_.front().fd);
        clients_.pop_front();
    }
    if (fd >= 0)
        clients_.push_back({fd, Clock::now() + patience, "", ""});
}

// Reads and writes what there is. False: the client has been served, or is not worth waiting for.
bool PageServer::goesOn(Client& client) const {
    char bytes[longestHead];
    ssize_t count = recv(client.fd, bytes, sizeof bytes, 0);
    if (count > 0 && client.out.empty()) {
        client.in.append(bytes, static_cast<size_t>(count));
        const size_t end = client.in.find("\r\n\r\n");
        if (end != std::string::npos && end <= longestHead)
            client.out = pages_.answer(client.in.substr(0, end), port_);
        else if (client.in.size() > longestHead)
            client.out = failure("431 Request Header Fields Too Large");
    }
    const bool hasLeft = count == 0 || (count < 0 && !isLater(count));
    if (client.out.empty())
        return !hasLeft && Clock::now() < client.end;
    count = send(client.fd, client.out.data(), client.out.size(), MSG_NOSIGNAL);
    if (count > 0)
        client.out.erase(0, static_cast<size_t>(count));
    return !client.out.empty() && (count > 0 || isLater(count)) && Clock::now() < client.end;
}

void PageServer::serve(const volatile std::sig_atomic_t& stop) {
    while (!stop) {
        std::vector<pollfd> fds{{listener_, POLLIN, 0}};
        for (const Client& client : clients_)
            fds.push_back(
                {client.fd, static_cast<short>(client.out.empty() ? POLLIN : POLLOUT), 0});
        poll(fds.data(), fds.size(), 200); // a signal may come just before
        size_t k = 1;
        for (auto client = clients_.begin(); client != clients_.end(); ++k) {
            const bool isDue = fds[k].revents || Clock::now() >= client->end;
            const bool stays = !isDue || goesOn(*client);
            if (!stays)
                close(client->fd);
            client = stays ? std::next(client) : clients_.erase(client);
        }
        if (fds[0].revents)
            accept();
    }
}
