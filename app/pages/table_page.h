#pragma once

#include "app/drawing/drawing.h"
#include "app/values/page_form.h"
#include "app/values/table.h"

namespace tessera::app {

/// A table as it is printed: rules above and below its heads and at its end, notes below. Every column and row is
/// there, in text of `form.text` points: what is wider than the page goes on in further blocks below with the columns
/// of `names` repeated, and texts are broken at blanks. The page is as wide as the form says, and as high as it takes.
/// Text is smaller where not even a name and a number have room beside each other.
VectorPage tablePage(const Table& table, const PageForm& form);

} // namespace tessera::app
