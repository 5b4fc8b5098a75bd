#include "app/importer/readers/vtk_messages.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vtkNew.h>
#include <vtkOutputWindow.h>

namespace tessera::importer {

namespace {

std::string reported; // the first error since throwReported

/// Sends all messages to stderr and keeps the first error.
class MessageWindow : public vtkOutputWindow {
public:
    static MessageWindow* New() {
        auto* window = new MessageWindow;
        window->InitializeObjectBase();
        return window;
    }
    void DisplayText(const char* text) override {
        const MessageTypes kind = GetCurrentMessageType();
        std::fprintf(stderr, "%s\n", text);
        const bool error = kind == MESSAGE_TYPE_ERROR || (kind != MESSAGE_TYPE_TEXT && meansMissing(text));
        if (error && reported.empty()) reported = firstReason(text);
    }

private:
    /// Some readers only warn about what they could not read, and fill it with zeros: take that as an error.
    static bool meansMissing(const std::string& text) {
        static constexpr const char* kWords[] = {"rror",   "EOF",      "nd of file", "runcated",
                                                 "ailed",  "ould not", "annot",      "nable to",
                                                 "issing", "remature", "nexpected",  "nrecognized"};
        return std::any_of(std::begin(kWords), std::end(kWords),
                           [&](const char* word) { return text.find(word) != std::string::npos; });
    }
    /// "ERROR: In file.cxx, line 12\nvtkReader (0x..): reason\n\n" -> "reason".
    static std::string firstReason(const std::string& text) {
        std::size_t begin = text.find("): ");
        if (begin == std::string::npos) begin = text.find('\n'); // a warning without an object
        begin = begin == std::string::npos ? 0 : begin + (text[begin] == '\n' ? 1 : 3);
        std::string line = text.substr(begin, 300);
        for (char& c : line)
            if (static_cast<unsigned char>(c) < ' ') c = ' ';
        while (!line.empty() && line.back() == ' ') line.pop_back();
        return line.empty() ? "error" : line;
    }
};

} // namespace

void catchMessages() {
    vtkNew<MessageWindow> window;
    vtkOutputWindow::SetInstance(window);
}

void throwReported() {
    if (reported.empty()) return;
    const std::string reason = reported;
    reported.clear();
    throw std::runtime_error(reason);
}

} // namespace tessera::importer
