#include "volume/import/files/file_block.h"

#include "volume/base/printable.h"

namespace tessera::volume {

void makePrintable(FileBlock& block) {
    for (std::string* const text :
         {&block.name, &block.lengthUnit, &block.timeUnit, &block.provenance, &block.timeName})
        *text = printable(*text);
    for (std::string& note : block.notes) note = printable(note);
    for (Array& array : block.arrays) {
        array.name = printable(array.name);
        array.unit = printable(array.unit);
        for (Label& label : array.labels) {
            label.name = printable(label.name);
            label.color = printable(label.color);
        }
    }
    for (Quantity& quantity : block.quantities) {
        quantity.name = printable(quantity.name);
        quantity.unit = printable(quantity.unit);
    }
}

} // namespace tessera::volume
