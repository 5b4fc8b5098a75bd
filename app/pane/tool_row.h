#pragma once

#include "app/pane/view_context.h"

/// The tools of a pane in rows above its main thing. In a small pane those without room are in a menu, so that the main
/// thing keeps most of the pane and every tool stays within reach.
namespace tessera::app {

/// Rows of tools in a pane with this much height left: at most a third of it, but one. `row`: height of one, with the
/// space below it.
int toolRows(float height, float row);

enum class ToolPlace { SameRow, NextRow, Menu };

/// Places tools of given widths one after the other.
class ToolPlaces {
public:
    /// `room`: width of a row; `menu`: width of the button that opens the menu, with the gap before it.
    ToolPlaces(float room, float menu, int rows) : room_(room), menu_(menu), left_(rows) {}
    /// The place of the next tool, `gap` behind the one before it. From the first in the menu on, all are there. The
    /// first tool is never there.
    ToolPlace next(float width, float gap);
    /// Whether a tool has room in the row begun last.
    bool fits(float width, float gap) const { return !full_ && used_ > 0 && used_ + gap + width <= roomNow(); }
    /// Whether the button of the menu is in the row begun last, else in one of its own.
    bool menuBeside() const { return used_ + menu_ <= room_; }
    /// Width of the widest tool that has room in every row.
    float widest() const { return room_ - menu_; }
    /// Widens the last tool by up to `by`, as far as its row has room; returns by how much.
    float grow(float by);

private:
    float roomNow() const { return left_ > 0 ? room_ : room_ - menu_; }

    float room_, menu_;
    float used_ = 0; ///< of the row begun last; 0: there is none
    int left_;       ///< rows not begun yet
    bool full_ = false;
};

/// The tools of one frame, drawn in sequence: each only where next() says so. A figure has none, nor room for them.
class ToolRow {
public:
    explicit ToolRow(const ViewContext& context);
    ToolRow(const ToolRow&) = delete;
    ToolRow& operator=(const ToolRow&) = delete;
    ~ToolRow();

    /// Goes to the place of a tool of this width, pixels. False where it is in the menu and that is closed, and in a
    /// figure.
    /// `gap`: pixels to the one before it; negative: as the style has it.
    bool next(float width, float gap = -1);
    /// The same for a text that says what is shown, which a figure has too.
    bool nextText(float width, float gap = -1);
    /// The width of the last tool, `least` so far, if it is widened to `most` as far as its row has room, pixels.
    float grow(float least, float most) { return inMenu() ? most : least + places_.grow(most - least); }
    /// Width of a row, pixels.
    float room() const { return room_; }
    /// Width of the widest tool that has room in every row, also in the last beside the button of the menu.
    float widest() const { return places_.widest(); }
    /// Whether a tool of this width has room in the row begun last.
    bool fits(float width) const;
    /// Whether there are so few rows that tools should be as narrow as they can. `enough`: rows that are not.
    bool narrow(int enough = 4) const { return rows_ < enough; }
    /// Whether the tool is in the menu.
    bool inMenu() const { return menu_ != Menu::None; }

private:
    const ViewContext& context_;
    ToolPlaces menuPlaces_; ///< in the menu
    float room_;
    int rows_;
    ToolPlaces places_;
    enum class Menu { None, Closed, Open } menu_ = Menu::None;
};

/// Asks where to save the table of an export as CSV, if it has one.
void exportTable(const ViewContext& context, const ViewExport& made);

/// A tool whose menu exports what a view shows: its picture, vector graphics, a table. Offers them also where there is
/// no menu. `atOneTime`: it shows the time of the session alone, which tables then state. `numbers`: where they come
/// from, if not all from the samples.
void exportMenu(ViewContext& context, ToolRow& tools, ViewExport made, bool atOneTime = true,
                const std::string& numbers = {});

} // namespace tessera::app
