/* A solver for writer.sh: appends computed times to an archive by the C library and acknowledges each on standard output;
 * with the argument "continue" it goes on where the archive ended. "arguments" instead checks what is refused, "axes"
 * writes a grid of uneven spacing. */
#define _POSIX_C_SOURCE 199309L
#include "tessera_writer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { NX = 11, NY = 7, NZ = 40, COUNT = NX * NY * NZ };

/* The value at sample i, component c and time t, the same in writer.sh. */
static double value(int i, int c, int t) {
    return sin(0.01 * i * (c + 1)) + 0.125 * t;
}

static int run(const char* path, int times, int continues, int lattice, double max_error, int pause_ms) {
    const struct timespec pause = {.tv_nsec = pause_ms * 1000000L};
    static double T[COUNT];
    static float U[3 * COUNT];
    const tessera_parameter parameters[] = {{.name = "T", .unit = "K", .type = TESSERA_DOUBLE},
                                            {.name = "U", .unit = "m/s", .components = 3, .type = TESSERA_FLOAT}};
    const tessera_grid grid = {.size = {NX, NY, NZ},
                               .spacing = {0.5, 0.5, 0.25},
                               .origin = {1, 2, 3},
                               .length_unit = "mm",
                               .lattice = lattice,
                               .max_error = max_error,
                               .continues = continues};
    tessera_writer* writer = tessera_writer_open(path, &grid, parameters, 2);
    if (!writer) return fprintf(stderr, "%s\n", tessera_writer_error()), 1;
    double last = -1;
    tessera_writer_times(writer, &last);
    for (int t = (int)last + 1; t < times; ++t) {
        for (int i = 0; i < COUNT; ++i) {
            T[i] = i % 26 == 0 ? INFINITY : i % 13 == 0 ? NAN : value(i, 0, t);
            for (int c = 0; c < 3; ++c) U[3 * i + c] = (float)value(i, c, t);
        }
        const void* arrays[] = {T, U};
        if (tessera_writer_append(writer, t, arrays) != 0) return fprintf(stderr, "%s\n", tessera_writer_error()), 1;
        printf("%d\n", t);
        fflush(stdout);
        nanosleep(&pause, NULL);
    }
    tessera_writer_close(writer);
    return 0;
}

static int failures = 0;

static void refused(const char* what, int failed, const char* text) {
    const char* error = tessera_writer_error();
    if (failed && strstr(error, text) && !strchr(error, '\n')) return;
    printf("FAILED: %s: %s\n", what, failed ? error : "was taken");
    ++failures;
}

/* Opening with one argument changed. */
static void refused_open(const char* path, tessera_grid grid, tessera_parameter parameter, const char* text) {
    const tessera_parameter two[] = {{.name = "p"}, parameter};
    tessera_writer* writer = tessera_writer_open(path, &grid, two, 2);
    refused(text, writer == NULL, text);
    tessera_writer_close(writer);
}

static int arguments(const char* path) {
    const tessera_grid grid = {.size = {4, 3, 2}, .spacing = {1, 1, 1}};
    const tessera_parameter T = {.name = "T"};
    tessera_grid other = grid;
    refused("no path", tessera_writer_open(NULL, &grid, &T, 1) == NULL, "no path");
    refused("no grid", tessera_writer_open(path, NULL, &T, 1) == NULL, "no grid");
    refused("no parameter", tessera_writer_open(path, &grid, NULL, 0) == NULL, "no parameter");
    refused_open(path, grid, (tessera_parameter){.name = NULL}, "has no name");
    refused_open(path, grid, (tessera_parameter){.name = "T\xe9"}, "is not UTF-8: T\xc3\xa9");
    refused_open(path, grid, (tessera_parameter){.name = "T", .unit = "\xb0" "C"}, "is not UTF-8: \xc2\xb0" "C");
    refused_open(path, grid, (tessera_parameter){.name = "p"}, "p: two parameters have this name");
    refused_open(path, grid, (tessera_parameter){.name = "U", .components = 2}, "U: has 2 components");
    refused_open(path, grid, (tessera_parameter){.name = "U", .type = 7}, "U: is neither TESSERA_FLOAT");
    other.size[1] = 0;
    refused_open(path, other, T, "a size is 0");
    other = grid, other.spacing[2] = 0;
    refused_open(path, other, T, "spacing must be greater");
    other = grid, other.spacing[2] = NAN;
    refused_open(path, other, T, "spacing must be greater");
    other = grid, other.max_error = 1.5;
    refused_open(path, other, T, "max_error is 1.5");
    other = grid, other.memory_mb = -1;
    refused_open(path, other, T, "memory_mb");
    other = grid, other.lattice = 9;
    refused_open(path, other, T, "lattice is neither");

    tessera_writer* writer = tessera_writer_open(path, &grid, &T, 1);
    float samples[24] = {0};
    const void *arrays[] = {samples}, *none[] = {NULL};
    double last = -7;
    refused("no writer", tessera_writer_append(NULL, 0, arrays) == 2, "no writer");
    refused("no arrays", tessera_writer_append(writer, 0, NULL) == 2, "no arrays");
    refused("no array", tessera_writer_append(writer, 0, none) == 2, "T: no array");
    refused("NaN", tessera_writer_append(writer, NAN, arrays) == 2, "not a finite number");
    if (tessera_writer_times(writer, &last) != 0 || last != -7) refused("times", 0, "");
    if (tessera_writer_append(writer, 2.5, arrays) != 0) refused("the first time", 1, "\n");
    if (tessera_writer_error()[0] != '\0') refused("an old error", 1, "\n");
    refused("the same time", tessera_writer_append(writer, 2.5, arrays) == 2, "2.5 is not after the last one");
    if (tessera_writer_times(writer, &last) != 1 || last != 2.5) refused("times", 0, "");
    tessera_writer_close(writer);
    tessera_writer_close(NULL);

    other = grid, other.continues = 1, other.size[0] = 5;
    refused("another grid", tessera_writer_open(path, &other, &T, 1) == NULL, "another grid");
    other = grid, other.continues = 1, other.max_error = 0.1;
    refused("another bound", tessera_writer_open(path, &other, &T, 1) == NULL, "another lattice or error bound");
    other = grid, other.continues = 1;
    refused("another name", tessera_writer_open(path, &other, &(tessera_parameter){.name = "O2"}, 1) == NULL,
            "other parameters");

    double large[24] = {0};
    large[5] = 1e300;
    const void* beyond[] = {large};
    writer = tessera_writer_open(path, &other, &(tessera_parameter){.name = "T", .type = TESSERA_DOUBLE}, 1);
    refused("no float", tessera_writer_append(writer, 3, beyond) == 2, "too large for a float");
    large[5] = 0;
    if (tessera_writer_append(writer, 3, beyond) != 0)
        refused("after a failure", 1, "\n");
    tessera_writer_close(writer);
    writer = tessera_writer_open("/no/such/folder/a.tsr", &grid, &T, 1);
    refused("no folder", tessera_writer_append(writer, 0, arrays) == 3, "/no/such/folder/a.tsr");
    tessera_writer_close(writer);
    return failures > 0;
}

/* An axis of cells along z, one of points along x, an even one along y; continued, and refused with other planes. */
static int axes(const char* path) {
    const double x[] = {0.1, 0.2, 1.0 / 3, 7}, z[] = {-1e-3, 0, 1e-5};
    double moved[] = {-1e-3, 1e-6, 1e-5}, falling[] = {0, 2, 1};
    const tessera_grid grid = {.size = {4, 3, 2}, .spacing = {0, 0.5, 0}, .origin = {0, 2, 0}};
    const tessera_parameter T = {.name = "T"};
    tessera_axes uneven = {.planes = {x, NULL, z}, .of = {TESSERA_POINTS, 0, TESSERA_CELLS}}, other = uneven;
    float samples[24];
    const void* arrays[] = {samples};
    for (int i = 0; i < 24; ++i) samples[i] = (float)i;
    other.planes[2] = falling;
    refused("falling", tessera_writer_open_axes(path, &grid, &other, &T, 1) == NULL, "axes, z: the planes of the axis do");
    other = uneven, other.of[0] = 2;
    refused("no kind", tessera_writer_open_axes(path, &grid, &other, &T, 1) == NULL, "axes, x: the planes are neither");
    refused("an even axis", tessera_writer_open(path, &grid, &T, 1) == NULL, "spacing must be greater");
    for (int time = 0; time < 2; ++time) {
        tessera_grid next = grid;
        next.continues = time;
        tessera_writer* writer = tessera_writer_open_axes(path, &next, &uneven, &T, 1);
        if (!writer || tessera_writer_append(writer, time, arrays) != 0) refused("axes", 1, "\n");
        tessera_writer_close(writer);
    }
    tessera_grid next = grid;
    next.continues = 1;
    other = uneven, other.planes[2] = moved;
    refused("other planes", tessera_writer_open_axes(path, &next, &other, &T, 1) == NULL, "another grid");
    return failures > 0;
}

int main(int count, char** words) {
    if (count == 3 && strcmp(words[1], "axes") == 0) return axes(words[2]);
    if (count == 3 && strcmp(words[1], "arguments") == 0) return arguments(words[2]);
    if (count < 6) return 2;
    return run(words[1], atoi(words[2]), strcmp(words[3], "continue") == 0, atoi(words[4]), atof(words[5]),
               count > 6 ? atoi(words[6]) : 0);
}
