#include "app/edits/open_worth.h"

#include "app/edits/label_names.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

using volume::FindingKind;

bool isPlace(const volume::Finding& finding) {
    return finding.kind == FindingKind::Outliers || finding.kind == FindingKind::Jump;
}

std::string nameOf(const volume::DatasetInfo& info, int channel) {
    return channel < 0 ? std::string() : info.channel(channel).name;
}

/// The stack with the most panes beside those of `from`, which would hide the list; that one where there is no other.
int stackBeside(const DockNode& node, const std::string& from, double share, double& most) {
    if (node.kind == DockKind::Tabs) {
        if (std::ranges::find(node.tabs, from) != node.tabs.end() || share <= most) return 0;
        most = share;
        return node.id;
    }
    int found = 0;
    for (std::size_t i = 0; i < node.children.size(); ++i) {
        const double part = i == 0 ? double(node.ratio) : 1 - double(node.ratio);
        if (const int id = stackBeside(node.children[i], from, share * part, most); id != 0) found = id;
    }
    return found;
}

/// A box around what was found, half a cell larger, so that its samples lie inside.
vis::BoxRegion boxAround(const volume::DatasetInfo& info, const volume::Box& box) {
    vis::BoxRegion region;
    region.center = box.center();
    const glm::dvec3 cell = info.lattice.lengthsAt(region.center);
    region.radius = box.size() * 0.5 + cell * 0.5;
    return region;
}

void brushFinding(Session& session, const volume::DatasetInfo& info, const volume::Finding& finding) {
    if (isPlace(finding)) {
        vis::Brush brush;
        const std::string base = nameOf(info, finding.x) + (finding.kind == FindingKind::Jump ? " jump" : " outliers");
        brush.name = base;
        const auto taken = [&] {
            return std::ranges::find(session.selection.brushes, brush.name, &vis::Brush::name) !=
                   session.selection.brushes.end();
        };
        brush.region = boxAround(info, finding.box);
        for (int number = 2; taken(); ++number) brush.name = base + " " + std::to_string(number);
        return brushAlone(session, std::move(brush));
    }
    const bool pair = finding.kind == FindingKind::Dependence || finding.kind == FindingKind::Contrast ||
                      finding.kind == FindingKind::Nonlinear;
    const auto label = volume::labelChannel(info);
    if (!pair || !finding.region || !label) return;
    const volume::Parameter& parameter = volume::parameterOf(info, *label);
    for (vis::Brush& each : session.selection.brushes) each.enabled = false;
    if (!regionBrushed(session, parameter, *finding.region)) toggleRegionBrush(session, parameter, *finding.region);
}

} // namespace

void brushAlone(Session& session, vis::Brush brush) {
    std::vector<vis::Brush>& brushes = session.selection.brushes;
    const auto same =
        std::ranges::find_if(brushes, [&](const vis::Brush& each) { return each.region == brush.region; });
    for (vis::Brush& each : brushes) each.enabled = false;
    if (same != brushes.end()) {
        same->enabled = true;
        same->inverted = false;
        same->combine = vis::BrushCombine::Or;
        return;
    }
    brush.combine = vis::BrushCombine::Or;
    brushes.push_back(std::move(brush));
}

ViewState viewOfFinding(const volume::Finding& finding, const volume::DatasetInfo& info) {
    const std::string x = nameOf(info, finding.x), y = nameOf(info, finding.y);
    switch (finding.kind) {
    case FindingKind::Dependence:
    case FindingKind::Contrast:
    case FindingKind::Nonlinear: {
        ScatterMatrixView view;
        view.channels = {x, y};
        return view;
    }
    case FindingKind::Outliers:
    case FindingKind::Jump: {
        SlicesView view;
        view.channel = x;
        return view;
    }
    case FindingKind::Change: {
        CurvesView view;
        view.x = info.timeName;
        view.y = {"mean(" + x + ")", "max(" + x + ")"};
        return view;
    }
    case FindingKind::Differs:
    case FindingKind::Around: {
        HistogramView view;
        view.channel = x;
        return view;
    }
    case FindingKind::Region: {
        StatisticsView view;
        view.byRegion = view.selected = true;
        return view;
    }
    case FindingKind::Time: {
        CurvesView view;
        view.x = info.timeName;
        view.brushed = true;
        if (!info.parameters.empty()) view.y = {"share(" + info.channels().front().name + ")"};
        return view;
    }
    }
    return SlicesView{};
}

std::string openFinding(Session& session, const volume::DatasetInfo& info, const volume::Finding& finding, int searched,
                        const std::string& from) {
    const bool overTime = finding.kind == FindingKind::Change || finding.kind == FindingKind::Time;
    const int time = overTime ? finding.time : searched;
    if (time >= 0 && std::size_t(time) < info.times.size()) session.time = info.times[std::size_t(time)];
    if (isPlace(finding) || finding.kind == FindingKind::Change) session.cursor = finding.place;
    brushFinding(session, info, finding);
    const ViewState view = viewOfFinding(finding, info);
    session.dock.maximised.clear();
    for (const auto& [pane, other] : session.views)
        if (other == view && pane != from) {
            showPane(session.dock, pane);
            return pane;
        }
    const std::string pane = addView(session, view);
    double most = 0;
    int stack = stackBeside(session.dock.root, from, 1, most);
    if (stack == 0) stack = stackWith(session.dock.root, from);
    insertPane(session.dock, pane, stack == 0 ? session.dock.root.id : stack, DockSide::Center);
    showPane(session.dock, pane);
    return pane;
}

} // namespace tessera::app
