# tessera-import, the only program that links VTK, and the VTK peer of the benchmarks. Without VTK the build goes on.
