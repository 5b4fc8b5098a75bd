#include "vis/transfer/transfer_recipe.h"

/// The transfer functions that ship with the program. Quantiles are of the values above the background of a scan, so
/// that they do not depend on how much air was scanned; they were chosen by eye on CT of an animal, a tooth and metal,
/// on weather and on fuel cells. Hounsfield units: water is 0, air -1000, compact bone from about 300 on.
namespace tessera::vis {

namespace {

glm::vec3 rgb(unsigned color) {
    return glm::vec3((color >> 16) & 255, (color >> 8) & 255, color & 255) / 255.0f;
}

RecipePoint point(double place, float opacity) {
    return {{.place = place}, opacity};
}
RecipePoint point(double place, float opacity, double hounsfield) {
    return {{.place = place, .hounsfield = hounsfield}, opacity};
}
RecipeColor color(double place, unsigned rgbColor) {
    return {{.place = place}, rgb(rgbColor)};
}
RecipeColor color(double place, unsigned rgbColor, double hounsfield) {
    return {{.place = place, .hounsfield = hounsfield}, rgb(rgbColor)};
}

std::vector<TransferRecipe> scans() {
    return {
        {.name = "CT bone",
         .help = "The densest parts of a scan, in the colours of bone",
         .opacity = {point(-1, 0), point(0.78, 0, 180), point(0.9, 0.5f, 400), point(1, 0.95f, 1800)},
         .colors = {color(0.78, 0x9c5a3c, 180), color(0.88, 0xe3c08e, 350), color(1, 0xfffbf0, 1500)}},
        {.name = "CT skin",
         .help = "The outer surface, where the object begins",
         .opacity = {point(-1, 0), point(0, 0, -500), point(0.08, 0.4f, -250), point(1, 0.6f, 200)},
         .colors = {color(0, 0xa8684c, -500), color(0.15, 0xdda483, -200), color(1, 0xffe6d6, 400)}},
        {.name = "CT skin, bone",
         .help = "Dense parts inside a clear outer surface",
         .opacity = {point(-1, 0), point(0, 0, -500), point(0.04, 0.025f, -350), point(0.1, 0.004f, -150),
                     point(0.78, 0.004f, 180), point(0.9, 0.5f, 400), point(1, 0.95f, 1800)},
         .colors = {color(0, 0xc98463, -500), color(0.7, 0xd79a78, 100), color(0.85, 0xe3c08e, 300),
                    color(1, 0xfffbf0, 1500)}},
        {.name = "CT vessels",
         .help = "What is bright by a contrast agent, in red; bone above it is pale",
         .opacity = {point(-1, 0), point(0.86, 0, 130), point(0.93, 0.12f, 200), point(0.97, 0.5f, 350),
                     point(1, 0.9f, 1200)},
         .colors = {color(0.86, 0x5c0a10, 130), color(0.93, 0xc8251e, 220), color(0.975, 0xf0905a, 400),
                    color(1, 0xfff4e2, 900)}},
        {.name = "CT lung",
         .help = "Tissue that holds air: values just above the background",
         .opacity = {point(-1, 0), point(0, 0, -960), point(0.04, 0.06f, -800), point(0.12, 0.05f, -600),
                     point(0.2, 0, -400), point(1, 0, 100)},
         .colors = {color(0, 0x3a5f9e, -960), color(0.08, 0x8fb7dc, -750), color(0.2, 0xf0c9bd, -400)}},
        {.name = "MR brain",
         .help = "Soft tissue of medium brightness, in shades of gray and rose",
         .opacity = {point(-1, 0), point(0.3, 0), point(0.5, 0.1f), point(0.8, 0.35f), point(1, 0.5f)},
         .colors = {color(0.3, 0x5a3c3c), color(0.6, 0xb48c84), color(0.85, 0xe6d2c8), color(1, 0xffffff)}},
        {.name = "MR vessels",
         .help = "The brightest few percent alone",
         .opacity = {point(-1, 0), point(0.95, 0), point(0.98, 0.3f), point(1, 0.95f)},
         .colors = {color(0.95, 0x6e0f14), color(0.98, 0xd63a2a), color(1, 0xffe0b4)}},
        {.name = "Radiograph",
         .help = "Everything a little, as if shone through",
         .colormap = "gray",
         .opacity = {point(-1, 0), point(0, 0), point(0.5, 0.012f), point(1, 0.1f)}},
    };
}

std::vector<TransferRecipe> fields() {
    return {
        {.name = "Gas",
         .help = "A thin cloud of all values, denser where they are high",
         .opacity = {point(-1, 0), point(0.3, 0), point(0.7, 0.008f), point(0.95, 0.06f), point(1, 0.3f)}},
        {.name = "Water",
         .help = "The highest third, as clear to deep blue water",
         .opacity = {point(-1, 0), point(0.65, 0), point(0.85, 0.08f), point(1, 0.7f)},
         .colors = {color(0.65, 0xd6f1f5), color(0.85, 0x4aa3df), color(1, 0x08306b)}},
        {.name = "Temperature",
         .help = "Hot parts glow, cool ones are clear",
         .colormap = "inferno",
         .opacity = {point(-1, 0), point(0.4, 0), point(0.7, 0.02f), point(0.9, 0.12f), point(1, 0.8f)}},
        {.name = "Low values",
         .help = "Where little is left: the lowest fifth",
         .colormap = "plasma",
         .reversed = true,
         .opacity = {point(-1, 0), point(-0.001, 0), point(0, 0.8f), point(0.08, 0.15f), point(0.2, 0), point(1, 0)}},
        {.name = "Extremes",
         .help = "The lowest and the highest tenth together",
         .colormap = "blue-red",
         .opacity = {point(-1, 0), point(-0.001, 0), point(0, 0.8f), point(0.04, 0.2f), point(0.1, 0), point(0.9, 0),
                     point(0.96, 0.2f), point(1, 0.8f)}},
        {.name = "Layers",
         .help = "Four thin shells of equal value, one inside the other",
         .opacity = {point(-1, 0), point(0.18, 0), point(0.2, 0.12f), point(0.22, 0), point(0.48, 0), point(0.5, 0.2f),
                     point(0.52, 0), point(0.78, 0), point(0.8, 0.35f), point(0.82, 0), point(0.94, 0),
                     point(0.96, 0.8f), point(1, 0.8f)}},
        {.name = "Solid",
         .help = "Everything above the background, opaque, coloured by quantiles",
         .opacity = {point(-1, 0), point(0, 0), point(0.02, 0.9f), point(1, 0.9f)},
         .colors = {color(0, 0x440154), color(0.25, 0x3b528b), color(0.5, 0x21918c), color(0.75, 0x5ec962),
                    color(1, 0xfde725)}},
        {.name = "Signed error",
         .help = "Large differences of either sign; none is clear",
         .aboutZero = true,
         .colormap = "blue-orange",
         .opacity = {point(-1, 0.9f), point(-0.97, 0.4f), point(-0.8, 0), point(0.8, 0), point(0.97, 0.4f),
                     point(1, 0.9f)}},
    };
}

} // namespace

std::span<const TransferRecipe> transferLibrary() {
    static const std::vector<TransferRecipe> all = [] {
        std::vector<TransferRecipe> made = scans();
        for (TransferRecipe& each : made) each.scan = true;
        for (TransferRecipe& each : fields()) made.push_back(std::move(each));
        return made;
    }();
    return all;
}

} // namespace tessera::vis
