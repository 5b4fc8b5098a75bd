// Linked into the test programs of a build with faults: notes for each test which faults it and the programs that it
// starts come to, in files "1", "2"... of the folder TESSERA_MUTANT_TESTS.
// A file's first line: name of the test, source file, passed (1) or not, seconds; then a fault's number a line.
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <string>

extern "C" void tesseraMutantForget();
extern "C" bool tesseraMutantReached(int fault);

namespace {

std::set<int> reachedNow() {
    std::set<int> out;
    for (int i = 0; i < 4096; ++i)
        if (tesseraMutantReached(i)) out.insert(i);
    return out;
}

class Notes : public testing::EmptyTestEventListener {
public:
    explicit Notes(std::string folder) : folder_(std::move(folder)) {}

    void OnTestSuiteStart(const testing::TestSuite&) override { tesseraMutantForget(); }
    void OnTestStart(const testing::TestInfo&) override {
        if (first_) suite_ = reachedNow(); // by the set-up that the tests of a suite share
        first_ = false;
        tesseraMutantForget();
        children_ = folder_ + "/children";
        std::remove(children_.c_str());
        setenv("TESSERA_MUTANT_COVER", children_.c_str(), 1);
    }
    void OnTestEnd(const testing::TestInfo& test) override {
        std::set<int> all = reachedNow();
        all.insert(suite_.begin(), suite_.end());
        std::ifstream children(children_);
        for (int fault; children >> fault;) all.insert(fault);
        std::ofstream out(folder_ + "/" + std::to_string(++count_));
        out << test.test_suite_name() << '.' << test.name() << '\t' << test.file() << '\t' << test.result()->Passed()
            << '\t' << static_cast<double>(test.result()->elapsed_time()) / 1000 << '\n';
        for (const int fault : all) out << fault << '\n';
        setenv("TESSERA_MUTANT_COVER", "", 1);
    }
    void OnTestSuiteEnd(const testing::TestSuite&) override { first_ = true; }

private:
    std::string folder_, children_;
    std::set<int> suite_;
    bool first_ = true;
    int count_ = 0;
};

const bool listening = [] {
    const char* folder = std::getenv("TESSERA_MUTANT_TESTS");
    if (folder) testing::UnitTest::GetInstance()->listeners().Append(new Notes(folder));
    return folder != nullptr;
}();

} // namespace
