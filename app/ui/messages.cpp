#include "app/ui/messages.h"

#include "volume/base/printable.h"
#include "volume/base/terminal.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <limits>

namespace tessera::app {

namespace {

std::string localClock() {
    char text[16] = "";
    const std::time_t time = std::time(nullptr);
    std::tm local{};
    if (localtime_r(&time, &local)) std::strftime(text, sizeof text, "%H:%M:%S", &local);
    return text;
}

} // namespace

Messages::Messages(std::function<double()> now, bool echo) : now_(std::move(now)), echo_(echo) {}

void Messages::add(const std::string& said, bool failure) {
    const std::string text = printableLines(said);
    messages_.push_back({text, localClock(), failure, now_(), false});
    if (messages_.size() > kKept) messages_.pop_front();
    if (echo_ && failure) warn("tessera: %s\n", text.c_str());
}

void Messages::setAside() {
    for (Message& each : messages_) each.gone = true;
}

std::vector<Messages::Message*> Messages::news() {
    std::vector<Message*> shown;
    for (auto each = messages_.rbegin(); each != messages_.rend(); ++each) {
        if (shown.size() == kNews || now_() - each->born > each->newSeconds()) each->gone = true;
        if (!each->gone) shown.push_back(&*each);
    }
    return shown;
}

double Messages::secondsToChange() const {
    double wait = std::numeric_limits<double>::infinity();
    for (const Message& each : messages_)
        if (!each.gone) wait = std::min(wait, std::max(0.05, each.born + each.newSeconds() - now_()));
    return wait;
}

} // namespace tessera::app
