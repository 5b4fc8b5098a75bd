#include "app/command/picture_options.h"

#include "app/command/command.h"
#include "app/data/apply_layout.h"
#include "app/data/format.h"
#include "app/data/import_options.h"
#include "app/data/library.h"
#include "app/described/describe_cli.h"
#include "app/described/key_words.h"
#include "app/history/parameter_path.h"
#include "app/session/shown_scene.h"
#include "app/ui/ticks.h"
#include "app/user_files/own_functions.h"
#include "app/user_files/state_dir.h"
#include "codec/remote/address.h"
#include "volume/base/error.h"
#include "volume/base/terminal.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace tessera::app {

namespace {

/// Applies "/json/pointer=value"; a value that is not JSON is taken as text.
void applySetting(Json& document, const std::string& setting) {
    const auto equals = setting.find('=');
    if (equals == std::string::npos || !setting.starts_with("/"))
        throw Error("needs /json/pointer=value", "--set", setting);
    try {
        setInDocument(document, setting.substr(0, equals), setting.substr(equals + 1));
    } catch (const Error&) {
        throw Error("no such place in the session", "--set", setting.substr(0, equals));
    }
}

/// Leaves a part of the decoration out, by its key.
void leaveOut(Decoration& decoration, const std::string& part) {
    std::string known;
    bool found = false;
    Decoration::describe(decoration, [&](bool& shown, const FieldInfo& info) {
        known += (known.empty() ? "" : ", ") + std::string(info.key);
        if (info.key != part) return;
        shown = false;
        found = true;
    });
    if (!found) throw CLI::ValidationError("--without", "has no part \"" + part + "\"; there are " + known);
}

/// The form that the options state together.
PictureForm formOf(const PictureOptions& options) {
    PictureForm form = options.form;
    const bool paper =
        std::ranges::any_of(options.onPaper, [](const CLI::Option* option) { return option->count() > 0; });
    if (paper) form.size.measure = PictureMeasure::Millimetres;
    if (!options.size.empty()) {
        if (paper) throw CLI::ValidationError("--size", "is in pixels: give it or a size on paper, not both");
        form.size.measure = PictureMeasure::Pixels;
        int& width = form.size.width;
        int& height = form.size.height;
        int end = 0;
        if (std::sscanf(options.size.c_str(), "%dx%d%n", &width, &height, &end) != 2 ||
            end != static_cast<int>(options.size.size()) || width < 16 || height < 16 || width > 16384 ||
            height > 16384)
            throw CLI::ValidationError("--size", "needs WIDTHxHEIGHT, 16 to 16384, e.g. 1600x1000");
    }
    for (const std::string& part : options.without) leaveOut(form.decoration, part);
    if (options.undecorated) form.decoration = *Decoration::preset("none");
    return form;
}

} // namespace

void addFormOptions(CLI::App& command, PictureOptions& options) {
    PictureForm& form = options.form;
    detail::addPresets(command, form.size, "--preset");
    command.add_option("--size", options.size, "Size of the picture in pixels")
        ->type_name("WxH")
        ->default_str(std::to_string(form.size.width) + "x" + std::to_string(form.size.height));
    PictureSize::describe(form.size, [&](auto& value, const FieldInfo& info) {
        // --size states these.
        if (info.key == "measure" || info.key == "width" || info.key == "height") return;
        detail::MemberToOption{command, ""}(value, info);
        if (info.key != "scale") options.onPaper.push_back(command.get_option(detail::optionName("--", info.key)));
    });
    PictureForm::describe(form, [&](auto& value, const FieldInfo& info) {
        if (info.key == "ground") detail::MemberToOption{command, ""}(value, info);
    });
    std::string parts;
    Decoration::describe(form.decoration, [&](const bool&, const FieldInfo& info) {
        parts += (parts.empty() ? "" : "|") + std::string(info.key);
    });
    command.add_option("--without", options.without, "Parts of the decoration to leave out: " + parts)
        ->type_name("PART,...")
        ->delimiter(',')
        ->expected(1)
        ->take_all();
    command.add_flag("--no-decoration", options.undecorated, "Draw the data alone, without any decoration");
}

std::string paneOf(const Session& session, const std::string& view) {
    if (session.views.contains(view)) return view;
    for (const auto& [pane, state] : session.views) {
        const auto kind =
            std::visit([](const auto& v) { return std::string_view(std::decay_t<decltype(v)>::kType); }, state);
        if (sameName(kind, view)) return pane;
    }
    return {};
}

void requireViews(const Session& session, const PictureOptions& options) {
    for (const std::string& name : viewsOf(options)) {
        if (!paneOf(session, name).empty()) continue;
        std::string known;
        for (const std::string& pane : paneKeys(session)) known += (known.empty() ? "" : ", ") + pane;
        forEachViewKind([&]<class Kind>(const Kind&) {
            const std::string kind(Kind::State::kType);
            if (paneOf(session, kind).empty()) known += (known.empty() ? "" : ", ") + kind;
        });
        throw Error("there is no view of this name; there are " + known, "--view", name);
    }
}

std::vector<std::string> viewsOf(const PictureOptions& options) {
    return options.view.empty() ? std::vector<std::string>() : CLI::detail::split(options.view, ',');
}

void addLayoutOption(CLI::App& command, std::string& layout) {
    std::string names;
    for (const std::string& name : layoutNames()) names += (names.empty() ? ": " : ", ") + name;
    command.add_option("--layout", layout, "Layout to show the data in, by file or name" + names)->type_name("LAYOUT");
}

void addTransferOption(CLI::App& command, std::vector<std::string>& transfer) {
    std::string names;
    for (const vis::TransferRecipe& recipe : vis::transferLibrary())
        names += (names.empty() ? ": " : ", ") + vis::quotedName(recipe);
    command
        .add_option(
            "--transfer", transfer,
            "Transfer function of the library, for the first layer or for PARAMETER, by name or one of your own" +
                names)
        ->type_name("[PARAMETER=]NAME")
        ->expected(1)
        ->take_all();
}

void addTimeOption(CLI::App& command, std::optional<double>& time) {
    command.add_option("--time", time,
                       "Time to show, in the unit of the data; in the whole window that of the timeline, which views "
                       "with a time of their own do not follow");
}

void showTime(Session& session, const volume::DatasetInfo& info, double time, const std::vector<std::string>& views) {
    session.time = timeWithin(info, time);
    for (const std::string& name : views) {
        VolumeView* const view = volumeView(session, paneOf(session, name));
        if (view && view->time) view->time = session.time;
    }
}

void addPictureOptions(CLI::App& command, PictureOptions& options) {
    command
        .add_option(
            "input", options.inputs,
            "Session, layout, picture exported by Tessera, data files, or a built-in model (default: fuel-cell)")
        ->type_name("SESSION|LAYOUT|DATA");
    addLayoutOption(command, options.layout);
    command
        .add_option("--view", options.view,
                    "Draw this view only, e.g. volume or histogram, or several as a figure with panels a, b, c "
                    "(default: the whole window)")
        ->type_name("VIEW,...");
    command.add_option("--columns", options.columns, "Panels side by side where there are several views")
        ->check(CLI::Range(1, 64));
    addFormOptions(command, options);
    command
        .add_option("--set", options.settings,
                    "Change a setting of the session, e.g. /camera/distance=1.5; may be repeated")
        ->type_name("/POINTER=VALUE")
        ->expected(1)
        ->take_all();
    addTransferOption(command, options.transfer);
    addImportOptions(command, options.import);
    addRemoteOptions(command, options.remote);
    addAllowRemoteOption(command);
}

namespace {

/// Fits the first view of data to the shape of a picture of it alone, unless its camera is stated.
void fitToPicture(Opened& opened, const PictureOptions& options) {
    const std::vector<std::string> views = viewsOf(options);
    const auto stated = [](const std::string& setting) { return setting.starts_with("/camera"); };
    if (!opened.firstView || views.size() != 1 || std::ranges::any_of(options.settings, stated)) return;
    Session& session = opened.document.session;
    const VolumeView* const view = volumeView(session, paneOf(session, views[0]));
    const PictureForm form = formOf(options);
    if (!view || view->camera || !(form.size.width > 0) || !(form.size.height > 0)) return;
    vis::fit(session.camera, vis::worldFrame(opened.source->info(), session.stretch),
             double(form.size.width) / double(form.size.height));
}

} // namespace

Opened openForPicture(const PictureOptions& options, const Progress& progress) {
    OpenRequest request;
    request.paths = options.inputs;
    request.layout = options.layout;
    if (!(options.import == volume::ImportOptions{})) request.import = options.import;
    if (!(options.remote == codec::RemoteOptions{})) request.remote = options.remote;
    if (!request.paths.empty() && request.layout.empty() && !codec::isRemote(request.paths[0]) &&
        !std::filesystem::exists(request.paths[0]) && request.paths[0].find('.') == std::string::npos &&
        !namesModel(request.paths[0])) {
        request.layout = request.paths[0];          // the name of a layout
        request.paths.erase(request.paths.begin()); // the remaining paths are data
    }
    Opened opened = open(request, progress);
    if (!opened.missing.empty()) {
        const DataFile& wanted = opened.missing.front().wanted;
        throw Error("data file not found; it was at " + wanted.absolutePath, wanted.path);
    }
    for (const std::string& name : viewsOf(options))
        if (const auto view = viewOfKind(name); view && paneOf(opened.document.session, name).empty())
            addView(opened.document.session, *view);
    if (!options.settings.empty()) {
        Json document = toJson(opened.document.session);
        for (const std::string& setting : options.settings) applySetting(document, setting);
        std::vector<JsonIssue> unknown;
        Session set = sessionFromJson(document, "--set", &unknown);
        takeAllowed(set.data, opened.document.session.data);
        opened.document.session = std::move(set);
        if (!unknown.empty()) throw Error("unknown key", "--set", unknown.front().path);
        const DataRef data = opened.document.session.data;
        if (!(data == opened.document.history.data())) opened = openWith(std::move(opened), data, progress);
        fitSession(opened.document.session, opened.source->info(), opened.messages);
    }
    if (request.layout.empty()) fitToPicture(opened, options);
    if (!options.transfer.empty()) {
        const OwnFunctions own = loadOwnFunctions(stateFolder());
        opened.messages.insert(opened.messages.end(), own.messages.begin(), own.messages.end());
        for (const std::string& words : options.transfer)
            applyNamed(opened.document.session, *opened.source, words, own.list);
    }
    for (const auto* const texts : {&opened.messages, &opened.warnings})
        for (const std::string& text : *texts) warn("tessera: %s\n", text.c_str());
    return opened;
}

PictureRequest pictureRequest(const PictureOptions& options, const Session& session) {
    PictureRequest request = pictureRequest(formOf(options), "");
    request.columns = options.columns;
    for (const std::string& name : viewsOf(options)) {
        const std::string pane = paneOf(session, name);
        request.panels.push_back(pane.empty() ? name : pane); // an unknown pane is reported when it is drawn
    }
    if (request.panels.size() == 1) request.pane = std::exchange(request.panels, {}).front();
    return request;
}

void requirePictureEnding(const std::string& path) {
    if (!hasEnding(path, ".png") && !hasEnding(path, ".svg") && !hasEnding(path, ".pdf"))
        throw Error("pictures are written as .png, .svg or .pdf", path);
}

Json aboutPicture(const PictureOptions& options, const Opened& opened) {
    return {{"session", printSession(opened.document, "session")},
            {"view", options.view},
            {"columns", options.columns},
            {"form", toJson(formOf(options))}};
}

} // namespace tessera::app
