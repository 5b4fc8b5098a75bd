#pragma once

#include <array>
#include <cfloat>
#include <cstddef>
#include <deque>
#include <imgui.h>

namespace tessera::app {

/// Mouse and key events in the order they came. ImGui 1.86 only sees states, once per frame: a key tapped or a button
/// clicked during one slow frame would be lost, a drag would begin where the mouse is later. So each frame takes only
/// as many events as one set of states can represent; the rest wait for the next frame. Letters typed into a field are
/// not states: a frame takes any number of them.
class InputQueue {
public:
    struct Event {
        enum Kind { Move, Button, Wheel, Key, Letter } kind = Move;
        int code = 0; ///< of a button or key; of a letter its Unicode number
        int scancode = 0, mods = 0;
        bool down = false;
        ImVec2 at{0, 0}; ///< of a wheel: how far it was turned
        double time = 0; ///< when it came, in seconds
    };
    static constexpr double kDoubleClick = 0.3; ///< longest time between both presses, in seconds

    /// Queues an event. A button press is placed at the last queued move, not at the current mouse position.
    void add(Event event) {
        if (event.kind == Event::Move) last_ = event.at;
        if (event.kind == Event::Button) event.at = last_;
        if (event.kind == Event::Move && !events_.empty() && events_.back().kind == Event::Move)
            events_.back() = event;
        else
            events_.push_back(event);
    }

    /// Takes the events of this frame; `key(event)` is called for each key event and letter. Afterwards `mouse` and
    /// `buttons` hold the states of this frame, `wheel` its turns, and `twice` whether a button went down soon after
    /// the last time: by when the presses came, since a frame takes one of them and may be slow. `typing`: a text field
    /// has the keyboard.
    template <class Function> void take(Function&& key, bool typing = false) {
        bool moved = false, clicked = false, wheeled = false, pressed = false;
        wheel = {0, 0};
        twice = false;
        std::array<bool, 512> changed{};
        while (!events_.empty()) {
            const Event event = events_.front();
            if (event.kind == Event::Move) {
                if (clicked || wheeled) break; // they happened before the move
                moved = true;
                mouse = event.at;
            } else if (event.kind == Event::Button) {
                if (clicked || moved || wheeled) break; // show a drag at its end before its release
                clicked = true;
                mouse = event.at;
                const auto button = static_cast<std::size_t>(event.code);
                if (button < buttons.size()) buttons[button] = event.down;
                if (button < buttons.size() && event.down) {
                    twice = event.time - pressed_[button] < kDoubleClick;
                    pressed_[button] = event.time;
                }
            } else if (event.kind == Event::Wheel) {
                if (clicked) break;
                wheeled = true;
                wheel = {wheel.x + event.at.x, wheel.y + event.at.y};
            } else if (event.kind == Event::Letter) {
                key(event);
            } else {
                // The key event of a letter adds nothing to the letter.
                constexpr int kControlAltSuper = 2 | 4 | 8; // as GLFW has them
                if (typing && event.code >= 32 && event.code <= 96 && (event.mods & kControlAltSuper) == 0) {
                    key(event);
                    events_.pop_front();
                    continue;
                }
                const std::size_t code = event.code < 0 ? 0 : static_cast<std::size_t>(event.code) % changed.size();
                // Keep the modifiers of a key press and of the wheel: their release waits for the next frame too.
                if (changed[code] || pressed || wheeled) break;
                changed[code] = true;
                const bool modifier = event.code >= kFirstModifier && event.code < kFirstModifier + 8;
                if (modifier) modifiers_[static_cast<std::size_t>(event.code - kFirstModifier)] = event.down;
                pressed = event.down && !modifier;
                key(event);
            }
            events_.pop_front();
        }
    }

    bool empty() const { return events_.empty(); }

    /// Whether either key of a modifier is down, by the events taken so far.
    enum Modifier { kShift, kControl, kAlt, kSuper };
    bool held(Modifier which) const { return modifiers_[which] || modifiers_[which + 4u]; }

    ImVec2 mouse{-FLT_MAX, -FLT_MAX};
    std::array<bool, 5> buttons{};
    ImVec2 wheel{0, 0};
    bool twice = false;

private:
    static constexpr int kFirstModifier = 340; ///< in GLFW: the left keys in the order of Modifier, then the right ones
    std::array<bool, 8> modifiers_{};
    std::array<double, 5> pressed_{-kDoubleClick, -kDoubleClick, -kDoubleClick, -kDoubleClick, -kDoubleClick};
    std::deque<Event> events_;
    ImVec2 last_{-FLT_MAX, -FLT_MAX};
};

} // namespace tessera::app
