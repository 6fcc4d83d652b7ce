/* SPDX-License-Identifier: MIT
 *
 * tcp_address: converts an endpoint of the tcp transport between three forms: its encoding in a
 * proxy, its string, and a socket address.
 */
#define _POSIX_C_SOURCE 200809L
#include "ice_message.h"
#include "tcp_private.h"

#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

Ice_Bool TcpEndpoint_readOptions(const char* options, TcpEndpoint_Address* address) {
    Ice_Int size, timeout = 60000;
    const char* text = Ice_findOption(options, 't', &size);
    if (text && size == 8 && memcmp(text, "infinite", 8) == 0)
        timeout = -1;
    else if (!Ice_integerOption(options, 't', 0x7FFFFFFF, &timeout) || timeout == 0)
        return 0;
    address->timeoutMs = timeout;
    address->port = 0;
    address->host.data = Ice_findOption(options, 'h', &address->host.size);
    address->compresses = Ice_hasOption(options, 'z');
    return Ice_areOptions(options, "htpz-") &&
           Ice_integerOption(options, 'p', 65535, &address->port);
}

void TcpEndpoint_encode(void* context, const char* options, Ice_OutputStreamPtr os) {
    TcpEndpoint* self = context;
    TcpEndpoint_Address at;
    Ice_Int begin;
    if (!TcpEndpoint_readOptions(options ? options : "", &at)) {
        os->failed = ICE_FAILED_MALFORMED;
        return;
    }
    if (!at.host.data)
        at.host = Ice_String_from(self->host);
    if (!options)
        at.port = self->port;
    else if (Ice_String_is(&at.host, "*"))
        /* "*" means all addresses; only a server can use it, so it is not allowed in a proxy */
        os->failed = ICE_FAILED_MALFORMED;
    Ice_OutputStream_writeShort(os, TCP_ENDPOINT_TYPE);
    begin = icec_beginEncapsulation(os);
    Ice_OutputStream_writeString(os, at.host);
    Ice_OutputStream_writeInt(os, at.port);
    Ice_OutputStream_writeInt(os, at.timeoutMs);
    Ice_OutputStream_writeBool(os, at.compresses);
    icec_endEncapsulation(os, begin);
}

int TcpEndpoint_decode(const Ice_Byte* encoded, Ice_Int size, TcpEndpoint_Address* address) {
    Ice_InputStream is;
    Ice_InputStream_init(&is, encoded, size);
    if (Ice_InputStream_readShort(&is) != TCP_ENDPOINT_TYPE)
        return 0;
    /* skips the size and the encoding of the encapsulation */
    (void)Ice_InputStream_readBlob(&is, 6);
    address->host = Ice_InputStream_readString(&is);
    address->port = Ice_InputStream_readInt(&is);
    address->timeoutMs = Ice_InputStream_readInt(&is);
    address->compresses = Ice_InputStream_readBool(&is);
    return !is.failed;
}

Ice_Bool TcpEndpoint_print(void* context, const Ice_Byte* encoded, Ice_Int size,
                           Ice_OutputStreamPtr text) {
    TcpEndpoint_Address at;
    const char* quote;
    char line[320];
    int n;
    (void)context;
    if (!TcpEndpoint_decode(encoded, size, &at))
        return 0;
    quote = memchr(at.host.data, ':', (size_t)at.host.size) ? "\"" : "";
    n = sprintf(line, "tcp -h %s%.*s%s -p %d -t ", quote, (int)at.host.size, at.host.data, quote,
                at.port);
    n += at.timeoutMs < 0 ? sprintf(line + n, "infinite") : sprintf(line + n, "%d", at.timeoutMs);
    n += sprintf(line + n, "%s", at.compresses ? " -z" : "");
    Ice_OutputStream_writeBlob(text, (const Ice_Byte*)line, n);
    return 1;
}

int TcpEndpoint_resolve(const TcpEndpoint_Address* address, TcpEndpoint_Place* places) {
    struct addrinfo hints, *found, *each;
    char name[256], service[8];
    int later, count = 0;
    if (address->host.size <= 0 || address->host.size >= (Ice_Int)sizeof name ||
        address->port < 0 || address->port > 65535)
        return 0;
    memcpy(name, address->host.data, (size_t)address->host.size);
    name[address->host.size] = 0;
    sprintf(service, "%d", address->port);
    memset(&hints, 0, sizeof hints);
    hints.ai_socktype = SOCK_STREAM;
    if (getaddrinfo(name, service, &hints, &found) != 0)
        return 0;
    for (later = 0; later < 2; ++later)
        for (each = found; each && count < TCP_PLACES; each = each->ai_next)
            if ((each->ai_family != AF_INET) == later) {
                memcpy(&places[count].at, each->ai_addr, each->ai_addrlen);
                places[count++].size = each->ai_addrlen;
            }
    freeaddrinfo(found);
    return count;
}

void TcpEndpoint_tune(int fd) {
    int on = 1;
    (void)setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    (void)setsockopt(fd, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
#ifdef TCP_USER_TIMEOUT
    /* Values for Linux. Keepalive: time until the first probe, s; time between probes, s.
     * TCP_USER_TIMEOUT: time-out for unacknowledged data, ms. */
    {
        int idle = 30, between = 10, all = 60000;
        (void)setsockopt(fd, IPPROTO_TCP, TCP_KEEPIDLE, &idle, sizeof idle);
        (void)setsockopt(fd, IPPROTO_TCP, TCP_KEEPINTVL, &between, sizeof between);
        (void)setsockopt(fd, IPPROTO_TCP, TCP_USER_TIMEOUT, &all, sizeof all);
    }
#endif
}

int TcpEndpoint_open(const TcpEndpoint_Place* to, Ice_Int timeoutMs) {
    struct pollfd wait;
    int failed = 1;
    socklen_t size = sizeof failed;
    wait.fd = socket(to->at.ss_family, SOCK_STREAM, 0);
    wait.events = POLLOUT;
    if (wait.fd < 0)
        return -1;
    (void)fcntl(wait.fd, F_SETFL, O_NONBLOCK);
    if (connect(wait.fd, (const struct sockaddr*)&to->at, to->size) == 0)
        failed = 0;
    else if (errno == EINPROGRESS && poll(&wait, 1, timeoutMs) == 1)
        (void)getsockopt(wait.fd, SOL_SOCKET, SO_ERROR, &failed, &size);
    if (failed) {
        (void)close(wait.fd);
        return -1;
    }
    return wait.fd;
}
