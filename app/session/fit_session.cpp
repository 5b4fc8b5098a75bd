#include "app/session/own_functions.h"
#include "app/session/session.h"
#include "app/session/shown_scene.h"

#include <algorithm>
#include <map>
#include <set>

namespace tessera::app {

namespace {

/// Makes the names in a session fit the parameters of a data set.
class Fitting {
public:
    Fitting(Session& session, const volume::DatasetInfo& info, std::vector<std::string>& messages)
        : session_(session), info_(info), messages_(messages), channels_(info.channels()),
          fallback_(firstChannel(info)) {
        for (const volume::Channel& channel : channels_) {
            const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(channel.parameter)];
            if (!parameter.categorical && (parameter.components == 1 || channel.magnitude))
                free_.push_back(channel.name);
        }
    }

    void layers() {
        for (auto* const layers : layerLists(session_))
            for (vis::Layer& layer : *layers) {
                std::visit([&](auto& technique) { fit(layer, technique); }, layer.technique);
                const auto named = [&](const vis::Lens& lens) { return lens.name == layer.lens; };
                if (layer.lens.empty() || std::ranges::any_of(session_.lenses, named)) continue;
                messages_.push_back("layer " + layerName(layer) + " is not drawn: there is no lens " + layer.lens);
                layer.visible = false;
                layer.lens.clear();
            }
    }

    void views() {
        for (auto& [key, view] : session_.views) {
            const auto* transfer = std::get_if<TransferView>(&view);
            if (transfer && ownFunction(session_, transfer->channel)) continue; // shows that of a layer or face alone
            std::visit([&](auto& each) { fitNames(each); }, view);
            if (auto* plots = std::get_if<ScatterMatrixView>(&view); plots && plots->enlarged.size() != 2)
                plots->enlarged.clear();
        }
    }

    void callouts() {
        for (Callout& callout : session_.callouts) fitNames(callout);
    }

    void brushes() {
        std::erase_if(session_.selection.brushes, [&](const vis::Brush& brush) {
            const std::vector<std::string> names = vis::regionChannels(brush.region);
            const bool lost = !std::ranges::all_of(names, [&](const std::string& name) { return known(name); });
            if (lost) messages_.push_back("brush " + brush.name + " is removed: its parameters are not in the data");
            return lost;
        });
    }

    /// Cross-hair and time lie inside.
    void place() {
        for (int axis = 0; axis < 3; ++axis) {
            const double lo = info_.bounds.lo[axis], hi = info_.bounds.hi[axis];
            double& at = session_.cursor[axis];
            if (!(at >= lo && at <= hi)) at = 0.5 * (lo + hi);
        }
        if (info_.times.empty()) return;
        const auto fitTime = [&](double& time) {
            if (!(time >= info_.times.front() && time <= info_.times.back()))
                time = info_.times[static_cast<std::size_t>(info_.nearestTime(time))];
        };
        fitTime(session_.time);
        if (info_.times.size() == 1) return; // the views' own times come back with the times
        for (auto& [pane, view] : session_.views)
            if (auto* const volume = std::get_if<VolumeView>(&view); volume && volume->time) fitTime(*volume->time);
        for (Callout& callout : session_.callouts)
            if (callout.time) fitTime(*callout.time);
    }

private:
    bool known(const std::string& name) const { return info_.findChannel(name).has_value(); }

    /// Replaces a missing name, the same one always by the same channel, different ones by different channels. Returns
    /// true if it was missing.
    bool replace(std::string& name) {
        if (name.empty() || known(name)) return false;
        auto found = standIn_.find(name);
        if (found == standIn_.end()) {
            const std::string with = standIn_.size() < free_.size() ? free_[standIn_.size()] : fallback_;
            found = standIn_.emplace(name, with).first;
            messages_.push_back("parameter " + name + " is not in the data; showing " + with + " instead");
        }
        name = found->second;
        return true;
    }

    /// Visits every member whose description says that it names a parameter.
    template <class Technique> void fit(vis::Layer& layer, Technique& technique) {
        bool replaced = false, standsNowhere = false; // the latter: of glyphs on a surface of an unknown parameter
        Technique::describe(technique, [&]<class Member>(Member& member, const FieldInfo& field) {
            if constexpr (std::is_same_v<Member, std::string>) {
                if (field.refersTo == "channel") {
                    if (replace(member)) {
                        if (!layer.name.empty()) layer.name = member;
                        replaced = true;
                    }
                    if (member.empty()) member = fallback_;
                } else if (field.refersTo == "vector") {
                    fitVector(member);
                } else if (field.refersTo == "optionalVector") {
                    if (!isVector(member)) member.clear();
                } else if (field.refersTo == "optionalChannel") {
                    if (field.key == "surface" && !member.empty() && !known(member)) {
                        messages_.push_back("layer " + layerName(layer) + " stands on a plane: " + member +
                                            " is not in the data");
                        standsNowhere = true;
                    }
                    if (!known(member)) member.clear();
                } else if (field.refersTo == "colorChannel" && !member.empty() && !known(member)) {
                    messages_.push_back("layer " + layerName(layer) + " keeps its own colours: " + member +
                                        " is not in the data");
                    member.clear();
                }
            } else if constexpr (std::is_same_v<Member, std::vector<vis::GlyphPart>>) {
                fitParts(member);
            } else if constexpr (std::is_same_v<Member, vis::Strokes>) {
                fitNames(member);
            }
        });
        if constexpr (requires { technique.surfaceValue; })
            if (technique.place == vis::GlyphPlace::Surface && standsNowhere) technique.place = {};
        if constexpr (requires { technique.value; })
            if (const auto index = info_.findChannel(technique.channel); replaced && index) {
                const Range range = info_.channelRange(channels_[static_cast<std::size_t>(*index)]);
                technique.value = 0.5 * (range.lo + range.hi);
            }
    }

    /// A part that would show the same as another for want of parameters is left out.
    void fitParts(std::vector<vis::GlyphPart>& parts) {
        std::set<std::string> taken;
        for (const vis::GlyphPart& part : parts)
            if (known(part.channel)) taken.insert(part.channel);
        std::erase_if(parts, [&](vis::GlyphPart& part) {
            if (!replace(part.channel)) return false;
            part.range = {0, 0}; // in the values of another parameter it means nothing
            return !taken.insert(part.channel).second;
        });
    }

    /// Every member of a view that names a parameter, and those of its members.
    template <class Owner> void fitNames(Owner& owner) {
        Owner::describe(owner, [&]<class Member>(Member& member, const FieldInfo& field) {
            if constexpr (Described<Member>) {
                fitNames(member);
            } else if constexpr (std::is_same_v<Member, std::string>) {
                if (field.refersTo == "channel")
                    replace(member);
                else if (field.refersTo.ends_with("ector") && !member.empty())
                    fitVector(member);
                else if (field.refersTo == "optionalChannel" && !known(member))
                    member.clear();
            } else if constexpr (std::is_same_v<Member, std::vector<std::string>>) {
                if (field.refersTo == "channel")
                    std::erase_if(member, [&](const std::string& name) { return !known(name); });
            }
        });
    }

    void fitVector(std::string& name) const {
        if (!isVector(name)) name = firstVector(info_);
    }

    bool isVector(const std::string& name) const {
        return std::ranges::any_of(info_.parameters, [&](const volume::Parameter& parameter) {
            return parameter.components == 3 && parameter.name == name;
        });
    }

    Session& session_;
    const volume::DatasetInfo& info_;
    std::vector<std::string>& messages_;
    std::vector<volume::Channel> channels_;
    std::string fallback_;
    std::vector<std::string> free_;              ///< channels not yet used as replacements
    std::map<std::string, std::string> standIn_; ///< by the name that is missing
};

} // namespace

void fitSession(Session& session, const volume::DatasetInfo& info, std::vector<std::string>& messages) {
    repair(session.dock, paneKeys(session));
    if (info.channels().empty()) return;
    colorDifferences(session);
    Fitting fitting(session, info, messages);
    fitting.layers();
    fitting.views();
    fitting.callouts();
    fitting.brushes();
    fitting.place();
}

} // namespace tessera::app
