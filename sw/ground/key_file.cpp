// SPDX-License-Identifier: MIT
//
// key_file: opens, checks and parses a key file.

#include "key_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <poll.h>
#include <sstream>
#include <stdexcept>
#include <sys/stat.h>
#include <unistd.h>

namespace XBeeAT {

namespace {

constexpr int anyVehicle = -1;
constexpr size_t mostBytes = 65536;
constexpr int pipeMs = 10000; // time-out for the first bytes from a pipe, ms
const char* const hexadecimal = "0123456789abcdefABCDEF";

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
    throw std::runtime_error("key file '" + path + "'" + why);
}

void checkOwner(const std::string& path, const struct stat& file) {
    if (!S_ISREG(file.st_mode) && !S_ISFIFO(file.st_mode))
        refuse(path, ": expected a file or a pipe");
    if (file.st_uid != geteuid() && file.st_uid != 0)
        refuse(path, " belongs to another user: chown it to the user who runs this program");
    if (file.st_mode & 077) {
        char mode[8];
        std::snprintf(mode, sizeof mode, "%04o", file.st_mode & 07777);
        refuse(path, std::string(" can be read by other users (mode ") + mode + "): chmod 600 '" +
                         path + "', and change the key if another user may have read it");
    }
}

bool isKey(const std::string& word) {
    return word.size() == 32 && word.find_first_not_of(hexadecimal) == std::string::npos;
}

LinkKey keyOf(const std::string& digits) {
    LinkKey key;
    for (size_t i = 0; i < key.size(); ++i)
        key[i] = static_cast<unsigned char>(std::stoul(digits.substr(2 * i, 2), nullptr, 16));
    return key;
}

// Returns the address in a word; a negative number if the word is not an address.
int addressOf(const std::string& word) {
    const bool isNumber = word.rfind("0x", 0) == 0 && word.size() > 2 && word.size() <= 6 &&
                          word.find_first_not_of(hexadecimal, 2) == std::string::npos;
    return isNumber ? std::stoi(word, nullptr, 16) : -1;
}

} // namespace

std::string readSecret(const std::string& path) {
    // opening a pipe without a writer must not block
    const int fd = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0)
        refuse(path, std::string(": ") + std::strerror(errno) +
                         "; to make a key: (umask 077; openssl rand -hex 16 >FILE)");
    std::unique_ptr<const int, void (*)(const int*)> closer(&fd, [](const int* f) { close(*f); });
    struct stat file;
    if (fstat(fd, &file) != 0)
        refuse(path, std::string(": ") + std::strerror(errno));
    checkOwner(path, file);
    pollfd waits{fd, POLLIN, 0};
    if (S_ISFIFO(file.st_mode) && poll(&waits, 1, pipeMs) == 0)
        refuse(path, " is a pipe to which no program writes");
    fcntl(fd, F_SETFL, 0);
    std::string text;
    char bytes[512];
    ssize_t count;
    while ((count = read(fd, bytes, sizeof bytes)) > 0 && text.size() <= mostBytes)
        text.append(bytes, static_cast<size_t>(count));
    explicit_bzero(bytes, sizeof bytes);
    if (count < 0)
        refuse(path, std::string(": ") + std::strerror(errno));
    if (text.size() > mostBytes)
        refuse(path, " is too long for a key file");
    return text;
}

KeyFile::KeyFile(const std::string& path) : path_(path) {
    std::string text = readSecret(path), line;
    const std::string mark = "\xEF\xBB\xBF"; // byte order mark that some editors write
    std::istringstream lines(text.compare(0, mark.size(), mark) == 0 ? text.substr(mark.size())
                                                                     : text);
    for (int number = 1; std::getline(lines, line); ++number) {
        std::istringstream words(line.substr(0, line.find('#')));
        std::vector<std::string> word;
        for (std::string w; words >> w;)
            word.push_back(w);
        if (word.empty())
            continue;
        const int address = addressOf(word[0]);
        if (address >= 0)
            word.erase(word.begin());
        bool good = word.size() == 1 || word.size() == 2;
        for (const std::string& w : word)
            good = good && isKey(w);
        const std::string where = ", line " + std::to_string(number) + ": ";
        if (!good)
            refuse(path, where + "expected [ADDRESS] KEY [NEXT], with keys of 32 hexadecimal "
                                 "digits and an address such as 0x0001");
        LinkKeys& keys = keys_[address < 0 ? anyVehicle : address];
        if (!keys.empty())
            refuse(path, where + "duplicate line for this vehicle");
        for (const std::string& w : word)
            keys.insert(keys.begin(), keyOf(w));
    }
    explicit_bzero(text.data(), text.size());
    if (keys_.empty())
        refuse(path, " has no key; to make a key: (umask 077; openssl rand -hex 16 >FILE)");
}

LinkKeys KeyFile::of(int address) const {
    if (path_.empty())
        return {};
    auto found = keys_.find(address);
    if (found == keys_.end() && address != everybody)
        found = keys_.find(anyVehicle);
    if (found == keys_.end()) {
        char text[64];
        std::snprintf(text, sizeof text, " has no line for %s 0x%04x",
                      address == everybody ? "all vehicles," : "the vehicle", address);
        refuse(path_, text);
    }
    return found->second;
}

} // namespace XBeeAT
