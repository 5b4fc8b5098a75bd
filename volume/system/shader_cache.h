#pragma once

namespace tessera {

/// Mesa, the OpenGL of most Linux systems, keeps compiled shaders in the user's cache folder. It writes the list of
/// them through memory, so that a full disk ends the program by a signal. Reserves the room of that list; where there
/// is none, switches the cache off for this process, by the environment. To be called before OpenGL starts, while no
/// other thread reads the environment, and again once there is a context, when Mesa has made the list.
void guardShaderCache();

} // namespace tessera
