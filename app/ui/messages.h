#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

namespace tessera::app {

/// Messages of the program, oldest first: all of them in the pane Messages, the newest for a while in the status line.
class Messages {
public:
    static constexpr std::size_t kKept = 500; ///< older ones are dropped
    static constexpr std::size_t kNews = 3;   ///< in the status line at a time

    struct Message {
        std::string text;
        std::string clock; ///< local time, "14:03:59"
        bool failure = false;
        double born = 0;   ///< s, by the clock
        bool gone = false; ///< no longer in the status line
        double newSeconds() const { return failure ? 30 : 7; }
    };

    /// `now`: seconds of a clock that only rises. `echo`: failures are written to the error stream too, for runs
    /// without a window.
    explicit Messages(std::function<double()> now, bool echo = false);

    void add(const std::string& text, bool failure = false);
    /// Takes all out of the status line: they are about what was shown before.
    void setAside();
    const std::deque<Message>& list() const { return messages_; }
    /// The messages in the status line at this time, newest first. Sets `gone` for those that are too old or too many.
    std::vector<Message*> news();
    /// Seconds until one of them disappears; infinity if there are none.
    double secondsToChange() const;

private:
    std::function<double()> now_;
    bool echo_;
    std::deque<Message> messages_;
};

} // namespace tessera::app
