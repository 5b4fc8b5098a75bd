#include "app/session/own_functions.h"

#include <gtest/gtest.h>

/// Functions of layers and cube faces that are gone.
namespace tessera::app {
namespace {

struct UnusedFunctions : ::testing::Test {
    UnusedFunctions() {
        info.parameters = {{"T", "K", 1, volume::ScalarType::F32, false, {}, {}},
                           {"O2", "mol/m3", 1, volume::ScalarType::F32, false, {}, {}}};
        session.layers = {{"one", true, vis::VolumeLayer{.channel = "T"}},
                          {"two", true, vis::VolumeLayer{.channel = "T"}}};
        session.transfer["T"].opacity = {{0, 0}, {1, 1}};
        session.transfer["O2"].opacity = {{0, 0}, {1, 0.5f}};
        session.views["function"] = TransferView{.channel = "T"};
        setOwnFunction(session, session.layers[0].transfer, "T", true, "T in one");
    }
    const std::string& shown() { return std::get<TransferView>(session.views["function"]).channel; }
    void removeFirstLayer() {
        const std::vector<OwnFunction> before = ownFunctions(session);
        session.layers.erase(session.layers.begin());
        removeUnused(session, before, info);
    }

    Session session;
    volume::DatasetInfo info;
};

TEST_F(UnusedFunctions, GoWithTheirLayer) {
    ASSERT_EQ(shown(), "T in one");
    removeFirstLayer();
    EXPECT_FALSE(session.transfer.contains("T in one"));
    EXPECT_EQ(shown(), "T");
    EXPECT_EQ(session.transfer.size(), 2u);
}

TEST_F(UnusedFunctions, StayWhileAnotherLayerHasThem) {
    session.layers[1].transfer = "T in one";
    removeFirstLayer();
    EXPECT_TRUE(session.transfer.contains("T in one"));
    EXPECT_EQ(shown(), "T in one");
}

TEST_F(UnusedFunctions, GoWithTheCubeWhoseFaceHadThem) {
    ShadowCubeView cube;
    cube.front.channel = "O2";
    setOwnFunction(session, cube.front.transfer, "O2", true, "face");
    session.views["cube"] = cube;
    const std::vector<OwnFunction> before = ownFunctions(session);
    ASSERT_EQ(before.size(), 2u);
    session.views.erase("cube");
    removeUnused(session, before, info);
    EXPECT_FALSE(session.transfer.contains("face"));
    EXPECT_TRUE(session.transfer.contains("T in one"));
    EXPECT_EQ(shown(), "O2");
}

TEST_F(UnusedFunctions, ThoseOfParametersStay) {
    session.layers[0].transfer = "O2"; // a session may say so
    removeFirstLayer();
    EXPECT_TRUE(session.transfer.contains("O2"));
}

} // namespace
} // namespace tessera::app
