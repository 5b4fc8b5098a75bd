#include "volume/base/terminal.h"

#include "volume/base/error.h"
#include "volume/base/printable.h"

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <unistd.h>

namespace tessera {

namespace {

int outputFailure = 0; ///< errno of the first failure of standard output

void put(const std::string& text, std::FILE* file) {
    errno = 0;
    if (std::fwrite(text.data(), 1, text.size(), file) < text.size() && file == stdout && outputFailure == 0)
        outputFailure = errno;
}

[[gnu::format(printf, 2, 0)]] void printTo(std::FILE* file, const char* format, std::va_list arguments) {
    std::va_list again;
    va_copy(again, arguments);
    const int length = std::vsnprintf(nullptr, 0, format, again);
    va_end(again);
    if (length < 0) return;
    std::string text(std::size_t(length) + 1, '\0');
    std::vsnprintf(text.data(), text.size(), format, arguments);
    text.pop_back();
    put(printableLines(text), file);
}

} // namespace

void say(const char* format, ...) {
    std::va_list arguments;
    va_start(arguments, format);
    printTo(stdout, format, arguments);
    va_end(arguments);
}

void warn(const char* format, ...) {
    std::va_list arguments;
    va_start(arguments, format);
    printTo(stderr, format, arguments);
    va_end(arguments);
}

void sayJson(const std::string& json) {
    put((isatty(STDOUT_FILENO) != 0 ? printableLines(json) : json) + "\n", stdout);
}

void finishOutput() {
    errno = 0;
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
    const int failure = outputFailure != 0 ? outputFailure : errno != 0 ? errno : EIO;
    throw MachineError(std::string("cannot be written: ") + std::strerror(failure), "standard output");
}

} // namespace tessera
