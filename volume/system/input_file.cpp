#include "volume/system/input_file.h"

#include "volume/base/byte_text.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tessera {

namespace {

std::string whyNotRead(const struct stat& about) {
    if (S_ISREG(about.st_mode)) return {};
    return S_ISDIR(about.st_mode) ? "is a folder" : kPipeOrDevice;
}

} // namespace

std::string whyNoFile(const std::string& path) {
    struct stat about {};
    if (::stat(path.c_str(), &about) == 0) return whyNotRead(about);
    return errno == ENOENT ? kNoSuchFile : std::strerror(errno);
}

void requireFile(const std::string& path) {
    if (const std::string why = whyNoFile(path); !why.empty()) throw Error(why, path);
}

std::ifstream openInput(const std::string& path) {
    requireFile(path);
    std::ifstream in(path, std::ios::binary);
    if (!in) throw Error(std::string("cannot be read: ") + std::strerror(errno), path);
    return in;
}

int openInputDescriptor(const std::string& path) {
    // Without waiting for somebody who writes to a pipe, as another file may lie there than a moment ago.
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (file < 0) throw Error(errno == ENXIO ? kPipeOrDevice : std::strerror(errno), path); // ENXIO: a socket
    struct stat about {};
    std::string why = ::fstat(file, &about) == 0 ? whyNotRead(about) : std::strerror(errno);
    if (why.empty()) return file;
    ::close(file);
    throw Error(why, path);
}

std::string readInput(const std::string& path, std::uintmax_t most) {
    std::ifstream in = openInput(path);
    std::string bytes;
    constexpr std::size_t kFirst = 4096, kMostPiece = 1 << 20; // most files that are read whole are small
    while (in) {                                               // its size need not be known, as of files in /proc
        const std::size_t before = bytes.size(), piece = std::clamp(before, kFirst, kMostPiece);
        bytes.resize(before + piece);
        in.read(bytes.data() + before, std::streamsize(piece));
        bytes.resize(before + std::size_t(std::max<std::streamsize>(in.gcount(), 0)));
        if (bytes.size() > most)
            throw Error("is larger than " + textOfBytes(double(most)) + ", more than is read", path);
    }
    if (in.bad()) throw Error("cannot be read", path);
    return bytes;
}

} // namespace tessera
