# tessera-import, the only program that reads with VTK. Without VTK the build goes on.
