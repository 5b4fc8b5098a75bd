#!/usr/bin/env python3
"""Writes the inputs of vtkhdf/, xdmf/, fluent_hdf/ and zarr/ beside this file, with h5py, meshio and zarr (Debian:
python3-h5py python3-meshio python3-zarr). vtkhdf/transient.vtkhdf and zarr/ome.zarr were made by others.

Where nothing else is said, a volume has 4 x 5 x 6 samples (x, y, z) of value x + 10 y + 100 z."""

import os
import shutil

import h5py
import meshio
import numpy as np
import zarr

os.chdir(os.path.dirname(os.path.abspath(__file__)))
nx, ny, nz = 4, 5, 6
z, y, x = np.meshgrid(np.arange(nz), np.arange(ny), np.arange(nx), indexing="ij")
value = (x + 10 * y + 100 * z).astype("f4")


def new(path):
    return h5py.File(path, "w", libver="latest")


def hexahedra(n, x0=0):
    """Points and corners of n x n x n unit cubes."""
    m = n + 1
    points = np.array([[x0 + a, b, c] for c in range(m) for b in range(m) for a in range(m)], float)
    corners = []
    for c in range(n):
        for b in range(n):
            for a in range(n):
                q = a + m * (b + m * c)
                low = [q, q + 1, q + 1 + m, q + m]
                corners.append(low + [p + m * m for p in low])
    return points, np.array(corners)


# --- VTKHDF ---
def root(file, kind, version=(2, 2), path="VTKHDF"):
    group = file.create_group(path, track_order=True)
    group.attrs["Version"] = np.array(version)
    group.attrs["Type"] = np.bytes_(kind)
    return group


def image(group, extent, direction=(1, 0, 0, 0, 1, 0, 0, 0, 1)):
    group.attrs["WholeExtent"] = np.array(extent)
    group.attrs["Origin"] = np.array([1.0, 2.0, 3.0])
    group.attrs["Spacing"] = np.array([0.5, 1.0, 2.0])
    group.attrs["Direction"] = np.array(direction, float)


def steps(group, values):
    of = group.create_group("Steps")
    of.attrs["NSteps"] = len(values)
    of["Values"] = np.array(values, float)
    return of


def one_part(group, points, corners):
    group["Points"], group["Connectivity"] = points, corners.ravel()
    group["Offsets"], group["Types"] = np.arange(len(corners) + 1) * 8, np.full(len(corners), 12, "u1")
    group["NumberOfPoints"], group["NumberOfCells"] = [len(points)], [len(corners)]
    group["NumberOfConnectivityIds"] = [corners.size]


with new("vtkhdf/image_times.vtkhdf") as f:  # a flip along x, three times, field data
    g = root(f, "ImageData")
    image(g, (2, 5, 0, 4, 0, 5), (-1, 0, 0, 0, 1, 0, 0, 0, 1))
    p = g.create_group("PointData")
    p["v"] = np.stack([value, value + 1000, value + 2000])
    p["same"] = value
    p["U"] = np.stack([np.stack([value + t, 2 * value, 3 * value], -1) for t in range(3)])
    p["short"], p["words"] = value[:2], np.bytes_("hello")
    s = steps(g, [0.1, 0.2, 0.4])
    s.create_group("PointDataOffsets")["v"] = [0, 1, 2]
    s.create_group("FieldDataOffsets")["voltage"] = [0, 1, 2]
    g.create_group("FieldData")["voltage"] = [0.6, 0.7, 0.8]
with new("vtkhdf/image_cells.vtkhdf") as f:
    g = root(f, "ImageData", (1, 0))
    image(g, (0, 4, 0, 5, 0, 6))
    g.create_group("CellData")["v"] = value
with new("vtkhdf/moving_parts.vtkhdf") as f:  # two parts of 8 cubes, twice as large at the second step, one ghost
    g = root(f, "UnstructuredGrid")
    points, corners = zip(*[hexahedra(2, 2 * part) for part in (0, 1)])
    g["Points"] = np.concatenate([p * (1 + t) for t in (0, 1) for p in points])
    g["Connectivity"] = np.concatenate([c.ravel() for t in (0, 1) for c in corners])
    g["Offsets"] = np.concatenate([np.arange(9) * 8] * 4)
    g["Types"] = np.full(32, 12, "u1")
    g["NumberOfPoints"], g["NumberOfCells"], g["NumberOfConnectivityIds"] = [27] * 4, [8] * 4, [64] * 4
    cells = g.create_group("CellData")
    cells["c"] = np.concatenate([np.arange(8.0) + 10 * part + 100 * t for t in (0, 1) for part in (0, 1)])
    ghosts = np.zeros(32, "u1")
    ghosts[15] = 1
    cells["vtkGhostType"] = ghosts
    s = steps(g, [0, 1])
    s["PartOffsets"], s["NumberOfParts"], s["PointOffsets"] = [0, 2], [2, 2], [0, 54]
    s["CellOffsets"], s["ConnectivityIdOffsets"] = [[0], [16]], [[0], [128]]
with new("vtkhdf/multi.vtkhdf") as f:  # a tree of two meshes and a surface
    g = root(f, "MultiBlockDataSet")
    for name, x0 in (("blk1", 0), ("blk0", 2)):
        block = root(f, "UnstructuredGrid", path="VTKHDF/" + name)
        one_part(block, *hexahedra(2, x0))
        block.create_group("CellData")["c"] = np.arange(8.0) + 10 * x0
    root(f, "PolyData", path="VTKHDF/surface")
    tree = g.create_group("Assembly", track_order=True)
    tree.create_group("fluid")["air"] = h5py.SoftLink("/VTKHDF/blk1")
    tree["solid"] = h5py.SoftLink("/VTKHDF/blk0")
    tree["skin"] = h5py.SoftLink("/VTKHDF/surface")
with new("vtkhdf/polyhedron.vtkhdf") as f:  # a cube as a polyhedron beside one as a hexahedron
    g = root(f, "UnstructuredGrid", (2, 5))
    faces = [[0, 3, 4, 1], [6, 7, 10, 9], [0, 1, 7, 6], [1, 4, 10, 7], [4, 3, 9, 10], [3, 0, 6, 9]]
    g["Points"] = np.array([[a, b, c] for c in (0, 1) for b in (0, 1) for a in (0, 1, 2)], float)
    g["Connectivity"] = [0, 1, 4, 3, 6, 7, 10, 9, 1, 2, 5, 4, 7, 8, 11, 10]
    g["Offsets"], g["Types"] = [0, 8, 16], np.array([42, 12], "u1")
    g["NumberOfPoints"], g["NumberOfCells"], g["NumberOfConnectivityIds"] = [12], [2], [16]
    g["NumberOfFaces"], g["NumberOfPolyhedronToFaceIds"], g["NumberOfFaceConnectivityIds"] = [6], [6], [24]
    g["FaceConnectivity"], g["FaceOffsets"] = np.array(sum(faces, [])), np.arange(7) * 4
    g["PolyhedronToFaces"], g["PolyhedronOffsets"] = np.arange(6), [0, 6, 6]
    g.create_group("CellData")["c"] = [5.0, 7.0]
with new("vtkhdf/amr.vtkhdf") as f:  # 4 x 4 x 2 cells, one of them as 8 finer ones
    g = root(f, "OverlappingAMR", (1, 0))
    g.attrs["Origin"] = np.zeros(3)
    for level, spacing, boxes, cells in (
        (0, 1.0, [[0, 3, 0, 1, 0, 1], [0, 3, 2, 3, 0, 1]], np.arange(32.0)),
        (1, 0.5, [[2, 3, 2, 3, 0, 1]], np.arange(8.0) + 100),
    ):
        own = g.create_group("Level%d" % level)
        own.attrs["Spacing"] = np.full(3, spacing)
        own["AMRBox"] = np.array(boxes, "i4")
        own.create_group("CellData")["d"] = cells

# --- XDMF ---
points, corners = hexahedra(3)
os.chdir("xdmf")  # meshio writes the heavy data of a series to the current folder
with meshio.xdmf.TimeSeriesWriter("meshio_series.xdmf") as w:
    w.write_points_cells(points, [("hexahedron", corners)])
    for t in (0.0, 0.25, 1.5):
        w.write_data(t, point_data={"T": points[:, 0] + t, "U": points * t}, cell_data={"c": [np.arange(27.0) + t]})
meshio.write(
    "meshio_mixed.xdmf",
    meshio.Mesh(
        np.vstack([points, [[3, 0, 5]]]),
        [("hexahedron", corners), ("pyramid", np.array([[48, 49, 53, 52, 64]]))],
        cell_data={"c": [np.arange(27.0), np.array([99.0])]},
    ),
    file_format="xdmf",
)
os.chdir("..")
with new("xdmf/heavy.h5") as f:
    f["T"], f["cells"] = value, value[:5, :4, :3]
    f["padded"] = np.pad(value, ((1, 2), (3, 1), (2, 2))).astype("i4")
    f["times"] = np.stack([value, value + 1000])
    f["x"], f["y"], f["z"] = np.arange(nx) * 0.5, np.arange(ny) * 1.0, np.arange(nz) * 2.0


def document(body):
    return f"""<?xml version="1.0" ?>
<!DOCTYPE Xdmf SYSTEM "Xdmf.dtd" [
<!ENTITY HeavyData "heavy.h5">
]>
<Xdmf Version="2.0" xmlns:xi="http://www.w3.org/2001/XInclude">
<Domain>
{body}
</Domain>
</Xdmf>
"""


def item(dims, text, more='Format="HDF"'):
    return f'<DataItem Dimensions="{dims}" NumberType="Float" {more}>{text}</DataItem>'


def attribute(name, inner, more='Center="Node"'):
    return f'<Attribute Name="{name}" {more}>{inner}</Attribute>\n'


image_grid = '<Topology TopologyType="3DCoRectMesh" Dimensions="6 5 4"/>\n<Geometry GeometryType="ORIGIN_DXDYDZ">%s%s</Geometry>\n' % (
    item(3, "3 2 1", 'Format="XML"'),
    item(3, "2 1 0.5", 'Format="XML"'),
)


def slab(rows, dims, source, source_dims):
    return f'<DataItem ItemType="HyperSlab" Dimensions="{dims}">' + item("3 %d" % (len(rows.split()) // 3), rows, 'Format="XML"') + item(source_dims, source) + "</DataItem>"


def write(name, body):
    with open("xdmf/" + name, "w") as out:
        out.write(document(body))


write(
    "image.xmf",
    item("6 5 4", "heavy.h5:/T", 'Name="T" Format="HDF"')
    + '<Grid Name="g">'
    + image_grid
    + attribute("T", item("6 5 4", "&HeavyData;:/T"))
    + attribute("part", slab("1 3 2  1 1 1  6 5 4", "6 5 4", "heavy.h5:/padded", "9 9 8"))
    + attribute("V", '<DataItem ItemType="Function" Function="JOIN($0 ; $1, $2)" Dimensions="6 5 4 3">' + item("6 5 4", "heavy.h5:/T") * 2 + "<DataItem Reference=\"/Xdmf/Domain/DataItem[@Name='T']\"/></DataItem>", 'AttributeType="Vector"')
    + attribute("sum", '<DataItem ItemType="Function" Function="$0 + $1" Dimensions="6 5 4">' + item("6 5 4", "heavy.h5:/T") * 2 + "</DataItem>")
    + attribute("gone", item("6 5 4", "heavy.h5:/nothing"))
    + attribute("faces", item("6 5 4", "heavy.h5:/T"), 'Center="Face"')
    + "</Grid>",
)
write("image_cells.xmf", '<Grid Name="g">' + image_grid + attribute("c", item("5 4 3", "heavy.h5:/cells"), 'Center="Cell"') + "</Grid>")
write(
    "lists.xmf",
    '<Grid><Topology TopologyType="3DRectMesh" Dimensions="6 5 4"/><Geometry GeometryType="VXVYVZ">'
    + item(4, "heavy.h5:/x") + item(5, "heavy.h5:/y") + item(6, "heavy.h5:/z")
    + "</Geometry>" + attribute("T", item("6 5 4", "heavy.h5:/T")) + "</Grid>",
)
at_time = lambda t: attribute("T", slab(f"{t} 0 0 0  1 1 1 1  1 6 5 4", "6 5 4", "heavy.h5:/times", "2 6 5 4"))
write(
    "time_list.xmf",
    '<Grid GridType="Collection" CollectionType="Temporal"><Time TimeType="List">' + item(2, "0.1 0.7", 'Format="XML"') + "</Time>"
    + '<Grid Name="a">' + image_grid + at_time(0) + "</Grid>"
    + '<Grid Name="b"><Topology Reference="XML">/Xdmf/Domain/Grid/Grid[1]/Topology</Topology>'
    + "<xi:include xpointer=\"xpointer(//Grid[@Name='a']/Geometry)\"/>" + at_time(1) + "</Grid></Grid>",
)
write(
    "included.xmf",
    '<Grid GridType="Collection" CollectionType="Temporal">'
    + "".join(f'<xi:include href="step{t}.xmf" xpointer="xpointer(//Xdmf/Domain/Grid)"/>' for t in (0, 1))
    + "</Grid>",
)
for t in (0, 1):
    write(f"step{t}.xmf", f'<Grid Name="g"><Time Value="{3 * t}.5"/>' + image_grid + at_time(t) + "</Grid>")


def cubes(name, x0):
    p, c = hexahedra(2, x0)
    text = lambda numbers: " ".join(str(n) for n in np.asarray(numbers).ravel())
    return (
        f'<Grid Name="{name}"><Topology TopologyType="Hexahedron" NumberOfElements="8">'
        + item("8 8", text(c), 'Format="XML"') + "</Topology><Geometry GeometryType=\"XYZ\">"
        + item("27 3", text(p), 'Format="XML"') + "</Geometry>"
        + attribute("p [Pa]", item(8, text(np.arange(8) + x0), 'Format="XML"'), 'Center="Cell"') + "</Grid>\n"
    )


write("blocks.xmf", '<Grid GridType="Collection" CollectionType="Spatial">' + cubes("air", 0) + cubes("solid", 2) + "</Grid>")

# --- Fluent: by the structure that public readers of VTK and pyfluent expect ---
OUTWARD = {
    "hex": [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]],
    "tet": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
    "wedge": [[0, 1, 2], [3, 5, 4], [0, 3, 4, 1], [1, 4, 5, 2], [2, 5, 3, 0]],
    "pyramid": [[0, 3, 2, 1], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
}
NUMBER = {"tri": 1, "tet": 2, "quad": 3, "hex": 4, "pyramid": 5, "wedge": 6, "poly": 7}


def ids(of, first, last):
    of.attrs["minId"], of.attrs["maxId"] = np.uint64(first), np.uint64(last)


def write_case(path, points, zones, species=(), dimension=3):
    """zones: [(name, [(kind, corners, or of a polyhedron its faces seen from outside)])]"""
    cells = [cell for _, of in zones for cell in of]
    faces, order = {}, []
    for number, (kind, corners) in enumerate(cells, 1):
        if dimension == 2:
            sides = [list(edge) for edge in zip(corners, corners[1:] + corners[:1])]
        else:
            sides = corners if kind == "poly" else [[corners[q] for q in side] for side in OUTWARD[kind]]
        for side in sides:
            key = tuple(sorted(side))
            if key in faces:
                faces[key][2] = number
            else:
                faces[key] = [side[::-1] if dimension == 3 else side, number, 0]  # its normal points into c0
                order.append(key)
    inner = [key for key in order if faces[key][2]]
    order = inner + [key for key in order if not faces[key][2]]
    with new(path) as f:
        text = "(rp ((materials ((mix mixture (species (names %s)))))))" % " ".join(species)
        f.create_group("settings")["Rampant Variables"] = np.array([text.encode()])
        mesh = f.create_group("meshes/1")
        mesh.attrs["dimension"] = np.int32(dimension)
        nodes = mesh.create_dataset("nodes/coords/1", data=np.asarray(points, float)[:, :dimension])
        ids(nodes, 1, len(points))
        about = mesh.create_group("cells/zoneTopology")
        sizes = [len(of) for _, of in zones]
        last = np.cumsum(sizes)
        about["id"], about["minId"], about["maxId"] = np.arange(2, 2 + len(zones)), last - sizes + 1, last
        about["cellType"] = np.zeros(len(zones), "i4")
        about["name"] = np.array([";".join(name for name, _ in zones).encode()])
        for section, (a, b) in enumerate(((0, len(inner)), (len(inner), len(order))), 1):
            if a == b:
                continue
            own = mesh.create_group("faces/nodes/%d" % section)
            ids(own, a + 1, b)
            own["nnodes"] = np.array([len(key) for key in order[a:b]], "i2")
            own["nodes"] = np.array([p + 1 for key in order[a:b] for p in faces[key][0]], "u4")
        for side, of in ((1, order), (2, inner)):
            if of:
                ids(mesh.create_dataset("faces/c%d/1" % (side - 1), data=np.array([faces[k][side] for k in of], "u4")), 1, len(of))


def write_data(path, fields, time=0.0, step=0):
    """fields: {variable: [(number of its first cell, values)]}"""
    with new(path) as f:
        text = "(38 ((flow-time %g) (time-step %d)))" % (time, step)
        f.create_group("settings")["Data Variables"] = np.array([text.encode()])
        cells = f.create_group("results/1/phase-1/cells")
        cells["fields"] = np.array([(";".join(fields) + ";").encode()])
        for variable, parts in fields.items():
            for section, (first, numbers) in enumerate(parts, 1):
                ids(cells.create_dataset("%s/%d" % (variable, section), data=np.asarray(numbers)), first, first + len(numbers) - 1)


def cube(a, b, c):
    q = a + 5 * (b + 3 * c)
    return "hex", [q, q + 1, q + 6, q + 5, q + 15, q + 16, q + 21, q + 20]


places = [[a, b, c] for c in range(3) for b in range(3) for a in range(5)]
air = [cube(a, b, c) for c in range(2) for b in range(2) for a in range(2)]
solid = [cube(a + 2, b, c) for c in range(2) for b in range(2) for a in range(2)]
middles = np.array([np.mean([places[p] for p in corners], 0) for _, corners in air + solid])
T = 300 + middles[:, 0]
zones = [("air", air), ("solid", solid)]
write_case("fluent_hdf/box.cas.h5", places, zones, ["h2", "o2", "h2o"])
fluid = {"SV_U": middles[:8, 0], "SV_V": middles[:8, 1], "SV_W": middles[:8, 2], "SV_P": middles[:8, 1], "SV_Y_0": middles[:8, 0] / 10}
write_data(
    "fluent_hdf/box.dat.h5",
    {"SV_T": [(1, T[:8]), (9, T[8:])], "SV_T_M1": [(1, T)], **{name: [(1, numbers)] for name, numbers in fluid.items()}},
)
write_case("fluent_hdf/run.cas.h5", places, zones)
for step in (2, 10, 100):
    write_data("fluent_hdf/run-1-%05d.dat.h5" % step, {"SV_T": [(1, T + step)], **({"SV_P": [(1, T)]} if step > 5 else {})}, step / 100, step)
corner = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1], [2, 0, 0], [2, 1, 0], [2, 0, 1], [2, 1, 1], [0.5, 0.5, 2], [1.5, 0.5, 2]]
kinds = [
    ("hex", [0, 1, 2, 3, 4, 5, 6, 7]), ("wedge", [1, 2, 8, 5, 6, 10]), ("wedge", [2, 9, 8, 6, 11, 10]),
    ("pyramid", [4, 5, 6, 7, 12]), ("tet", [5, 10, 6, 13]), ("poly", [[5, 6, 12], [5, 13, 6], [6, 13, 12], [5, 12, 13]]),
]
write_case("fluent_hdf/kinds.cas.h5", corner, [("mix", kinds)])
write_data("fluent_hdf/kinds.dat.h5", {"SV_T": [(1, np.arange(1.0, 7))]})
flat = [[a, b, 0] for b in range(3) for a in range(4)]
write_case("fluent_hdf/flat.cas.h5", flat, [("fluid", [("quad", [a + 4 * b, a + 1 + 4 * b, a + 5 + 4 * b, a + 4 + 4 * b]) for b in range(2) for a in range(3)])], dimension=2)
write_data("fluent_hdf/flat.dat.h5", {"SV_T": [(1, np.arange(6.0))], "SV_U": [(1, np.arange(6.0))], "SV_V": [(1, np.arange(6.0) * 2)]})

# --- OME-Zarr ---
shutil.rmtree("zarr/tczyx.zarr", ignore_errors=True)
group = zarr.open_group("zarr/tczyx.zarr", mode="w")
data = np.stack([np.stack([value + 10000 * c + 1000 * t for c in range(2)]) for t in range(3)]).astype(">u2")
array = group.create_dataset("0", shape=data.shape, dtype=data.dtype, chunks=(2, 2, 4, 5, 3), dimension_separator="/", compressor=zarr.Blosc(cname="zstd", shuffle=2))
array[...] = data
axes = [{"name": "t", "type": "time", "unit": "second"}, {"name": "c", "type": "channel"}]
axes += [{"name": n, "type": "space", "unit": "micrometer"} for n in "zyx"]
moved = [{"type": "scale", "scale": [1.5, 1, 2, 0.5, 0.25]}, {"type": "translation", "translation": [0, 0, 10, 20, 30]}]
group.attrs["multiscales"] = [{"version": "0.4", "axes": axes, "datasets": [{"path": "0", "coordinateTransformations": moved}]}]
group.attrs["omero"] = {"channels": [{"label": "DAPI"}, {"label": "GFP"}]}
