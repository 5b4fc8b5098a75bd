#ifndef TESSERA_WRITER_H
#define TESSERA_WRITER_H

/* Writes a Tessera archive (.tsr) from a running solver, one time after the other, in C or C++.
 *
 * A time that tessera_writer_append() has acknowledged is on disk: other programs read it at once, and it stays
 * readable whatever happens to the solver afterwards. Functions that fail return a value other than 0
 * (tessera_writer_open: NULL); tessera_writer_error() then says why. Nothing is half appended, and the writer can still
 * be used.
 *
 * One writer is used by one thread at a time. Arrays are compressed on all cores that the process may use. In a solver
 * of several processes one of them writes, with the gathered arrays. */

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define TESSERA_API __attribute__((visibility("default")))
#else
#define TESSERA_API
#endif

typedef struct tessera_writer tessera_writer;

/* Numbers of an array in memory. Archives store floats: doubles are rounded. */
enum { TESSERA_FLOAT = 0, TESSERA_DOUBLE = 1 };

/* Lattice of the stored samples: all of the grid, or 70.7 % of them, resampled to the body-centred cubic lattice. */
enum { TESSERA_CC = 0, TESSERA_BCC = 1 };

typedef struct {
    const char* name; /* "T" */
    const char* unit; /* "K"; NULL: none */
    int components;   /* 1, or 3 of a vector; 0 counts as 1 */
    int type;         /* of the array given to tessera_writer_append(): TESSERA_FLOAT or TESSERA_DOUBLE */
} tessera_parameter;

/* Members that are 0 have defaults, except size and spacing. */
typedef struct {
    int size[3];             /* number of samples along x, y and z */
    double spacing[3];       /* between samples, in length_unit */
    double origin[3];        /* position of the first sample */
    const char* length_unit; /* of spacing and origin, such as "m"; NULL: not stated */
    const char* time_unit;   /* NULL: "s" */
    const char* name;        /* of the data; NULL: the name of the file */
    int lattice;             /* TESSERA_CC or TESSERA_BCC */
    double max_error;        /* of a sample, relative to the range of the parameter over the times so far; 0: exact */
    double memory_mb;        /* limit for packing; 0: a quarter of the machine's */
    int continues;           /* 0: an archive that exists is replaced by the first time; else it is continued */
} tessera_grid;

/* Opens an archive for writing; the file appears with the first time. NULL if the arguments are wrong, or if an archive
 * to continue does not fit them. The arguments are copied. */
TESSERA_API tessera_writer* tessera_writer_open(const char* path, const tessera_grid* grid,
                                                const tessera_parameter* parameters, int parameter_count);

/* What planes of an axis are: borders of cells, whose samples lie in the middle of them, or places of samples. */
enum { TESSERA_CELLS = 0, TESSERA_POINTS = 1 };

/* Axes of uneven spacing, along x, y and z. */
typedef struct {
    const double* planes[3]; /* rising, in length_unit: size + 1 borders of cells, or size points; NULL: an even axis,
                                of the spacing and the origin of the grid, which are not read of other axes */
    int of[3];               /* TESSERA_CELLS or TESSERA_POINTS */
} tessera_axes;

/* The same on a grid of uneven spacing. The planes are copied. `axes` may be NULL. */
TESSERA_API tessera_writer* tessera_writer_open_axes(const char* path, const tessera_grid* grid,
                                                     const tessera_axes* axes, const tessera_parameter* parameters,
                                                     int parameter_count);

/* Appends one time, greater than all before. arrays[p] holds parameter p at all samples, x fastest, then y, then z, the
 * components of a vector next to each other. Samples that are not finite are stored as absent. Returns 0 once the time
 * is on disk, 2 if the data are wrong, 3 if the machine failed (disk full, not enough memory). */
TESSERA_API int tessera_writer_append(tessera_writer* writer, double time, const void* const* arrays);

/* Number of times in the archive; the last one is stored in *last_time unless that is NULL or there is none. */
TESSERA_API long tessera_writer_times(const tessera_writer* writer, double* last_time);

/* Frees the writer, which may be NULL. The archive is complete without it. */
TESSERA_API void tessera_writer_close(tessera_writer* writer);

/* Why the last function called by this thread failed, one line; "" if it did not. Valid until the next call. */
TESSERA_API const char* tessera_writer_error(void);

#ifdef __cplusplus
}
#endif

#endif
