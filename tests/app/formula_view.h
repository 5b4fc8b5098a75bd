#pragma once

#include "app/platform/gui.h"
#include "app/workbench/workbench.h"
#include "tests/app/formula_cell.h"
#include "vis/gl/headless.h"
#include "volume/sources/centred_source.h"
#include "volume/sources/memory_source.h"

#include <functional>
#include <gtest/gtest.h>

namespace tessera::app {

/// One view of the formula cell or of other small data, numbers as computed and pictures on BCC, in a workbench without
/// a window.
class FormulaView : public testing::Test {
protected:
    /// `controls`: with the rows of tools, as exports need them.
    explicit FormulaView(bool controls = true)
        : workbench({.headless = true, .onlyPane = "pane", .controls = controls}) {}
    /// Shows the cell in this view alone, at the second time.
    void install(const ViewState& view, const std::string& unit = "K") {
        install([&] { return formula::makeCell(unit); }, view,
                [](Session& session) {
                    session.cursor = {0.0123, 0.0041, -0.0009};
                    session.time = 0.5;
                    session.render.samples = 1; // soon drawn
                });
    }
    /// Shows data that `make` makes, with changes to their session.
    void install(const std::function<volume::Dataset()>& make, const ViewState& view,
                 const std::function<void(Session&)>& change) {
        Opened opened;
        opened.numbers = volume::makeMemorySource(make(), {});
        opened.source = volume::makeCentredSource(opened.numbers, std::size_t(1) << 26);
        DataRef data;
        data.model = "fuel-cell"; // has no file
        opened.document.session = defaultSession(opened.source->info(), data);
        Session& session = opened.document.session;
        session.views.clear();
        session.views["pane"] = view;
        change(session);
        opened.document.history.reset(session);
        workbench.install(std::move(opened));
        start = workbench.session();
    }
    vis::Image picture(const Session& session, glm::ivec2 size = {420, 640}) {
        workbench.session() = session;
        return drawUntilDone(workbench, size, 1);
    }
    /// What Export writes of the view as it shows a session.
    std::string table(const Session& session) {
        picture(session);
        const ViewExport* offered = workbench.exported("pane");
        return offered && offered->table ? csvOf(offered->table({})) : std::string();
    }

    vis::HeadlessContext gl;
    Gui gui;
    Workbench workbench;
    Session start; ///< as it was installed
};

} // namespace tessera::app
