// SPDX-License-Identifier: MIT

#include "files.h"
#include "process.h"

#include <cerrno>
#include <cstdint>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>

namespace fs = std::filesystem;

std::string readFile(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in)
        throw std::runtime_error(fmt::format("cannot read {}", file.string()));
    return {std::istreambuf_iterator<char>(in), {}};
}

void writeFile(const fs::path& file, const std::string& text) {
    const fs::path part = file.string() + ".part";
    std::ofstream out(part, std::ios::binary);
    out << text;
    out.close();
    if (!out) {
        fs::remove(part);
        throw std::runtime_error(fmt::format("cannot write {}: is the disk full?", file.string()));
    }
    fs::rename(part, file);
}

std::string hexHash(const std::vector<std::string>& contents) {
    uint64_t hash = 14695981039346656037u;
    const auto mix = [&](unsigned char c) { hash = (hash ^ c) * 1099511628211u; };
    for (const std::string& content : contents) {
        for (const char c : content)
            mix(static_cast<unsigned char>(c));
        for (size_t rest = content.size(), k = 0; k < 8; k++, rest >>= 8)
            mix(static_cast<unsigned char>(rest)); // where one ends and the next begins
    }
    return fmt::format("{:016x}", hash);
}

std::string treeState(const fs::path& source, const std::string& folders) {
    // tests/regress/tool.py has the same: names, then hashes, of files in their order.
    static const char* script = R"(cd "$0"
files=$(git grep --no-index --exclude-standard --no-color -l '' | LC_ALL=C grep -E "^(${1// /|})/" |
    LC_ALL=C sort)
hashes=$([ -z "$files" ] || echo "$files" | git hash-object --stdin-paths)
printf '%s' "${files:+$files
$hashes
}" | git hash-object --stdin)";
    const std::string hash = run({"bash", "-c", script, source.string(), folders}).text;
    return folders + ": " + hash.substr(0, 16);
}

std::string pageStyle() {
    return readFile(LIBRARIES ".css") + readFile(COMMON_PAGE "/common.css") +
           readFile(COMMON_PAGE "/tables.css");
}

std::string pageScript() {
    return readFile(LIBRARIES ".js") + readFile(COMMON_PAGE "/common.js") +
           readFile(COMMON_PAGE "/tables.js");
}

std::string filled(std::string page, const std::map<std::string, std::string>& places) {
    for (const auto& [place, text] : places) {
        const size_t at = page.find(place);
        if (at == std::string::npos)
            throw std::runtime_error("the page has no " + place);
        page.replace(at, place.size(), text);
    }
    return page;
}

std::string scriptSafe(std::string json) {
    for (size_t at = 0; (at = json.find("</", at)) != std::string::npos; at += 3)
        json.replace(at, 2, "<\\/");
    return json;
}

FolderLock::FolderLock(const fs::path& folder, const std::string& program) {
    fs::create_directories(folder);
    const fs::path file = folder / "lock";
    const auto check = [&](int result) {
        if (result < 0)
            throw std::system_error(errno, std::generic_category(), file.string());
        return result;
    };
    file_ = check(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
    if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
        std::string holder = readFile(file);
        fmt::print(stderr, "{}: waiting for another run in {}{} ...\n", program, folder.string(),
                   holder.empty() ? "" : " (process " + holder + ")");
        int result;
        while ((result = flock(file_, LOCK_EX)) != 0 && errno == EINTR)
            ;
        check(result);
    }
    const std::string me = std::to_string(getpid());
    check(ftruncate(file_, 0));
    check(static_cast<int>(write(file_, me.data(), me.size())));
}

FolderLock::~FolderLock() {
    close(file_);
}
