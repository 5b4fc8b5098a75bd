// The process that stands in for tessera-import says of whole and of damaged files what the program says.
#include "tests/import/forked_importer.h"

#include "tests/import/foreign_files.h"
#include "volume/export/export.h"

#include <set>

namespace tessera::volume {
namespace {

using ForkedImporter = ForeignFiles;

TEST_F(ForkedImporter, AnswersAsTheProgram) {
    if (std::getenv("TESSERA_IMPORT") != nullptr) GTEST_SKIP() << "only the program is started";
    Dataset dataset;
    dataset.info.lattice.size = {5, 4, 3};
    dataset.info.parameters = {{"T", "K", 1, ScalarType::F32, false, {}, {}}};
    dataset.read = [](int, int, int) {
        Field field = makeField(Lattice{.size = {5, 4, 3}}, ScalarType::F32);
        for (std::size_t i = 0; i < field.count(); ++i) field.as<float>()[i] = float(i * i);
        return field;
    };
    const std::string whole = (folder_ / "a.vti").string();
    exportDataset(dataset, {}, whole);
    const std::string cut = write("b.vti", read(whole).substr(0, 700));
    const fs::path before = fs::current_path();
    fs::current_path(folder_);
    std::set<std::string> said, reasons;
    for (int i = 0; i < 12; ++i) {
        const Starts until = starts();
        said.insert(contents("a.vti"));
        reasons.insert(failure("b.vti"));
        EXPECT_EQ(starts().all, until.all + 2);
    }
    fs::current_path(before);
    EXPECT_EQ(said.size(), 1u);
    EXPECT_EQ(reasons.size(), 1u) << testing::PrintToString(reasons);
    EXPECT_THAT(*reasons.begin(), testing::HasSubstr("b.vti"));
    EXPECT_GE(starts().ofTheProgram * 16, starts().all);
    EXPECT_LE((starts().ofTheProgram - 1) * 16, starts().all);
}

} // namespace
} // namespace tessera::volume
