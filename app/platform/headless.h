#pragma once

#include "app/drawing/drawing.h"
#include "app/workbench/workbench.h"

/// The workbench without a window: the same frames, drawn into memory.
namespace tessera::app {

/// The page that a request asks for, on the ground of a theme or on white.
PageForm pageForm(const PictureRequest& request, Theme theme);

/// Called with the workbench after it has drawn its picture.
using Inspect = std::function<void(const Workbench&)>;

/// Writes a picture of a session to a file, in the GL context that is current if the renderer needs one: what the
/// window would show (.png), or the page of it (.svg, .pdf). Its file contains the session. Throws Error, MachineError.
void writePicture(const SessionDocument& document, const Sources& sources, std::shared_ptr<vis::Renderer> renderer,
                  const PictureRequest& request, const std::string& path, const Inspect& inspect = {});

/// A renderer with a GL context without a window, or where there is no OpenGL the processor alone: makes any number of
/// pictures of one data set.
class PictureMaker {
public:
    /// Says on stderr that there is no OpenGL.
    explicit PictureMaker(const vis::RendererOptions& options = {});
    ~PictureMaker();
    PictureMaker(const PictureMaker&) = delete;
    PictureMaker& operator=(const PictureMaker&) = delete;

    /// The table of the view of request.pane as CSV. Throws Error where it has none.
    std::string table(const SessionDocument& document, const Sources& sources, const PictureRequest& request,
                      const Progress& progress = {});

    /// The page that write() writes as SVG or PDF: figures of views that have all that is shown, else what render()
    /// would draw, as vector graphics. It has the size that is asked for; a table is as high as its rows take.
    VectorPage page(const SessionDocument& document, const Sources& sources, const PictureRequest& request);

    /// writePicture.
    void write(const SessionDocument& document, const Sources& sources, const PictureRequest& request,
               const std::string& path, const Inspect& inspect = {});

    vis::Image render(const SessionDocument& document, const Sources& sources, const PictureRequest& request,
                      const Inspect& inspect = {});

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessera::app
