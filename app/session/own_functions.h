#pragma once

#include "app/session/session.h"

#include <optional>
#include <string>
#include <vector>

/// Transfer functions that a layer or a face of a shadow cube has of its own, in place of that of its parameter.
namespace tessera::app {

struct OwnFunction {
    std::string name;    ///< in Session::transfer
    std::string channel; ///< whose values it maps, by the first that has it; "" = the channel of the first layer
};

/// Those in use, each once: of layers in their order, then of faces.
std::vector<OwnFunction> ownFunctions(const Session& session);
/// The one of a name; nothing if there is none.
std::optional<OwnFunction> ownFunction(const Session& session, const std::string& name);

/// Takes away those of `before`, from ownFunctions(), that nothing has any more: its layer or view has gone. Views of
/// the transfer function that show one show that of its parameter. A function that is a parameter's stays.
void removeUnused(Session& session, const std::vector<OwnFunction>& before, const volume::DatasetInfo& info);

/// A layer that now shows another parameter than `before`, from ownFunctions(), says of its function drops that.
void dropFormerFunction(Session& session, vis::Layer& layer, const std::vector<OwnFunction>& before,
                        const volume::DatasetInfo& info);

/// The parameter whose values a layer's own function maps: of a surface, the one that colours it.
const std::string& channelOfFunction(const vis::Technique& technique);

/// The layer selected in the first list of layers, else the first.
std::size_t selectedLayer(const Session& session);

/// The function that a view of the transfer function shows, by its name in Session::transfer: the one chosen there,
/// else that of the layer selected in the pane of layers. The session's layers are those of the volume view used last.
std::string shownFunction(const Session& session, const TransferView& view);
/// Views of the transfer function show that of the layer selected.
void followSelectedLayer(Session& session);

/// Gives what has `transfer` for the name of its function one of its own, which begins as that of `channel` and views
/// of the transfer function then show; or takes it away, and with it a function that nothing else has.
void setOwnFunction(Session& session, std::string& transfer, const std::string& channel, bool own,
                    const std::string& name);

} // namespace tessera::app
