// What self_test.py puts faults into: main prints what each function makes, so that every fault shows.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

struct Range {
    double lo = 0, hi = 0;
};

constexpr int doubled(int a) {
    return a * 2; // computed by the compiler: no fault
}

double span(const Range& range) {
    return range.hi - range.lo;
}

int digits(int value) {
    int count = 1;
    while (value >= 10) {
        value /= 10;
        count += 1;
    }
    return count;
}

std::string text(bool found, const std::string& name) {
    if (!found || name.empty()) return "absent";
    return name + "!";
}

void sorted(std::vector<int>& values) {
    std::sort(values.begin(), values.end());
}

int main() {
    std::printf("%g %d %d %d\n", span({1, 4}), doubled(2), digits(9), digits(100));
    std::printf("%s %s %s\n", text(true, "a").c_str(), text(false, "a").c_str(), text(true, "").c_str());
    std::vector<int> values{3, 1, 2};
    sorted(values);
    for (const int value : values) std::printf("%d ", value);
}
