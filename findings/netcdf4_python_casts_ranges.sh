#!/bin/sh
# The conventions of NetCDF let valid_min, valid_range and missing_value of packed data be in the unpacked unit where
# their type is that of scale_factor: 281.0 K beside packed int16. netCDF4 for Python casts them to the packed type as
# they are set, without a word where they are whole: 281.0 becomes the packed number 281, which is 282.81 K, and its own
# reader masks what is below that. (281.5 is kept with a warning, and then not used.) So a file may say another range
# than its writer meant, and only the type in the file tells which is stored.
# python3-netcdf4 1.6.2-1+b1 (Debian 12). Seen: "int16 281 and 281 samples masked; 100 are below 281.0 K". Exit status 0:
# still so.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
for package in python3-netcdf4=1.6.2-1+b1 python3-cftime=1.6.2-3+b1 python3-numpy=1:1.24.2-1+deb12u1 \
    libnetcdf19=1:4.9.0-3+b1 libhdf5-103-1=1.10.8+repack1-1 libhdf5-hl-100=1.10.8+repack1-1 libsz2=1.0.6-1+b1 \
    libaec0=1.0.6-1+b1 libblas3=3.11.0-2 liblapack3=3.11.0-2; do
    apt-get -qq download "$package"
done
for package in *.deb; do dpkg -x "$package" root; done
libraries=root/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH="$libraries:$libraries/blas:$libraries/lapack"
PYTHONPATH=root/usr/lib/python3/dist-packages /usr/bin/python3 - << 'END'
import netCDF4
import numpy

with netCDF4.Dataset("a.nc", "w") as file:
    file.createDimension("x", 400)
    variable = file.createVariable("T", "i2", ("x",))
    variable.set_auto_maskandscale(False)
    variable[:] = numpy.arange(400)  # 280 K to 283.99 K
    variable.scale_factor = 0.01
    variable.add_offset = 280.0
    variable.valid_min = 281.0
with netCDF4.Dataset("a.nc") as file:
    least = file["T"].valid_min
    masked = numpy.ma.count_masked(file["T"][:])
print(least.dtype, least, "and", masked, "samples masked; 100 are below 281.0 K")
raise SystemExit(0 if least.dtype == numpy.int16 and masked == 281 else 1)
END
