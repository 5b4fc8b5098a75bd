#include "volume/import/names/vectors.h"

#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

/// The vectors found among scalars of these names, as "U: Ux Uy Uz".
std::string vectorsOf(const std::vector<std::string>& names, int layers = 2, const std::set<std::string>& kept = {}) {
    DatasetInfo info;
    info.lattice.size = {3, 3, layers};
    for (const std::string& name : names) info.parameters.push_back({name, "", 1, ScalarType::F32, false, {}, {}});
    std::string out;
    for (const NamedVector& vector : findVectors(info, kept)) {
        out += (out.empty() ? "" : "; ") + vector.name + ":";
        for (const int component : vector.components) out += component < 0 ? " 0" : " " + names[std::size_t(component)];
    }
    return out;
}

TEST(Vectors, FormFromTheNamesOfTheirComponents) {
    for (const auto& [names, wanted] : std::vector<std::pair<std::vector<std::string>, std::string>>{
             {{"u", "v", "w"}, "U: u v w"},
             {{"U", "V", "W"}, "U: U V W"},
             {{"T", "Uz", "Ux", "Uy"}, "U: Ux Uy Uz"},
             {{"X_VELOCITY", "Y_VELOCITY", "Z_VELOCITY"}, "U: X_VELOCITY Y_VELOCITY Z_VELOCITY"},
             {{"x-velocity", "y-velocity", "z-velocity"}, "U: x-velocity y-velocity z-velocity"},
             {{"vel_x", "vel_y", "vel_z"}, "U: vel_x vel_y vel_z"},
             {{"velx", "vely", "velz"}, "U: velx vely velz"},
             {{"VelocityX", "VelocityY", "VelocityZ"}, "U: VelocityX VelocityY VelocityZ"},
             {{"xvelocity", "yvelocity", "zvelocity"}, "U: xvelocity yvelocity zvelocity"},
             {{"Velocity[i]", "Velocity[j]", "Velocity[k]"}, "U: Velocity[i] Velocity[j] Velocity[k]"},
             {{"U:0", "U:1", "U:2"}, "U: U:0 U:1 U:2"},
             {{"U_0", "U_1", "U_2"}, "U: U_0 U_1 U_2"},
             {{"SV_U", "SV_V", "SV_W"}, "U: SV_U SV_V SV_W"},
             {{"Velocity u", "Velocity v", "Velocity w"}, "U: Velocity u Velocity v Velocity w"},
             {{"momentum x", "momentum y", "momentum z"}, "momentum: momentum x momentum y momentum z"},
             {{"Velocity field, x component", "Velocity field, y component", "Velocity field, z component"},
              "U: Velocity field, x component Velocity field, y component Velocity field, z component"},
             {{"Velocity_field,_x-component", "Velocity_field,_y-component", "Velocity_field,_z-component"},
              "U: Velocity_field,_x-component Velocity_field,_y-component Velocity_field,_z-component"},
             {{"Mean X Velocity", "Mean Y Velocity", "Mean Z Velocity"},
              "Mean Velocity: Mean X Velocity Mean Y Velocity Mean Z Velocity"},
             {{"velocity", "velocity_x", "velocity_y", "velocity_z"}, "U: velocity_x velocity_y velocity_z"},
             {{"J.x", "J.y", "J.z", "u", "v", "w"}, "J: J.x J.y J.z; U: u v w"}})
        EXPECT_EQ(vectorsOf(names), wanted) << names.front();
}

TEST(Vectors, DoNotFormOfOtherNames) {
    for (const std::vector<std::string>& names :
         std::vector<std::vector<std::string>>{{"u", "v"},
                                               {"x", "y", "z"},
                                               {"Ux", "Uy"},
                                               {"Ux", "Uy", "UZ"},
                                               {"a", "b", "c"},
                                               {"tau_xx", "tau_xy", "tau_xz", "tau_yy"},
                                               {"Sxx", "Sxy", "Sxz"},
                                               {"stress_x_x", "stress_x_y", "stress_x_z"},
                                               {"Y_0", "Y_1", "Y_2"},
                                               {"U:0", "U:1", "U:2", "U:3"},
                                               {"phase_1", "phase_2", "phase_3"},
                                               {"Points:0", "Points:1", "Points:2"},
                                               {"O2", "H2", "N2"},
                                               {"i", "j", "k"}})
        EXPECT_EQ(vectorsOf(names), "") << names.front();
    EXPECT_EQ(vectorsOf({"u", "v"}, 1), "U: u v 0") << "in a plane";
    EXPECT_EQ(vectorsOf({"u", "v", "w"}, 2, {"v"}), "") << "asked for by name";
}

TEST(Vectors, HaveOneUnitAndType) {
    DatasetInfo info;
    info.lattice.size = {2, 2, 2};
    for (const char* name : {"u", "v", "w"})
        info.parameters.push_back({name, "m/s", 1, ScalarType::F32, false, {}, {}});
    EXPECT_EQ(findVectors(info).size(), 1u);
    DatasetInfo other = info;
    other.parameters[1].unit = "K";
    EXPECT_TRUE(findVectors(other).empty());
    other = info;
    other.parameters[2].type = ScalarType::U8;
    EXPECT_TRUE(findVectors(other).empty());
    other = info;
    other.parameters[0].categorical = true;
    EXPECT_TRUE(findVectors(other).empty());
}

} // namespace
} // namespace tessera::volume
