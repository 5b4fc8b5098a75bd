// Decisions of vis/formulas, which are functions there.
float choose(bool which, float a, float b) {
    return which ? a : b;
}
