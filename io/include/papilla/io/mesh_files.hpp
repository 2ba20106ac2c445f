// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/io/read_options.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

/// Reads a Wavefront OBJ with its MTL files and pictures.
///
/// Parts: one per object (`o`); in a file without objects one per group (`g`); in a file without either one. `usemtl`
/// gives the material slots, groups within an object the face numbers. Vertices are numbered as in the file (those that
/// a part does not use are left out) and not merged. Polygons of any shape are cut into triangles; negative indices
/// count from the end; indices may point ahead. Numbers have a decimal point whatever the locale. Names may hold spaces
/// and any UTF-8. Six numbers behind `v` are a position and an sRGB colour.
/// Lines, points and free-form geometry are listed in `losses`; missing materials and pictures, faces of fewer than
/// three corners, and colours or normals that are not finite in `warnings`.
/// Cost: linear in the file's size, quadratic in the corners of a concave polygon. Deterministic.
/// @throws IoError when the file can't be read; InvalidInput naming file, line and reason for everything else.
Scene read_obj(const std::filesystem::path& path, const ReadOptions& options = {});

/// Writes all instances of a scene as OBJ in millimetres and the scene's axes, node transforms applied, one `o` an
/// instance, with texture channel 0 and normals where the mesh has them. When there are materials, a file of the same
/// name with .mtl, and beside it the base colour, emission and normal pictures, named after the OBJ file and the
/// picture. Numbers are written so that reading gives the same doubles. Vertex colours are written
/// behind the positions (sRGB) when they have one value at every position. Channel 1, extras and extensions have no
/// place. The same scene gives the same bytes; each file replaces its old one only when complete, the OBJ last.
/// @returns what has no place in OBJ, one sentence each.
/// @throws InvalidInput when a number is not finite or an index is out of range; IoError when writing fails.
std::vector<std::string> write_obj(const Scene& scene, const std::filesystem::path& path);

/// Reads an OFF file of Geomview, ASCII or binary (big endian), as one part: [ST][C][N]OFF with normals, colours (three
/// or four numbers; integers are divided by 255; sRGB) and texture coordinates of vertices, polygons of any shape, and
/// colours of faces. The keyword may be missing; "#" begins a comment; numbers have a decimal point whatever the
/// locale. Vertices are not merged. Numbers of a colour map are listed in `losses`; faces of fewer than three corners,
/// and values other than positions that are not finite in `warnings`. Cost: linear in the file's size, quadratic in the
/// corners of a concave polygon; the file's size, and about 60 bytes per triangle. Deterministic.
/// @throws IoError when the file can't be read; InvalidInput naming file, line (ASCII) or byte, and reason for
///         everything else, also for points of another dimension than three (4OFF, nOFF).
/// Source: Geomview manual, "OFF Files", http://www.geomview.org/docs/html/OFF.html
Scene read_off(const std::filesystem::path& path, const ReadOptions& options = {});

/// Writes all instances of a scene as one ASCII [ST][C][N]OFF of triangles in millimetres and the scene's axes, node
/// transforms applied. Numbers are written so that reading gives the same doubles. Normals, colours (sRGB in [0, 1])
/// and texture coordinates are written when they have one value at every position. The same scene gives the same bytes;
/// a failure leaves the old file as it was.
/// @returns what OFF has no place for, one sentence each.
/// @throws InvalidInput when a number is not finite or an index is out of range; IoError when writing fails.
std::vector<std::string> write_off(const Scene& scene, const std::filesystem::path& path);

/// Reads a PLY 1.0 file, ASCII or binary of either byte order, with properties of any type in any order, as one part.
///
/// Of vertices: x y z, nx ny nz, red green blue alpha (integers are divided by their largest value; sRGB), and texture
/// coordinates s t, u v, texture_u texture_v or texture_s texture_t, and CAD (u,v) cad_u cad_v. Of faces: the list
/// vertex_indices or vertex_index (polygons of any shape are cut into triangles), texcoord (a pair per corner, as
/// MeshLab writes it), cad_uv (the same), texnumber, red green blue alpha. Of tristrips: vertex_indices, −1 starts a
/// new strip. Every "comment TextureFile" becomes a material with that picture. Vertices are not merged. Other
/// properties and elements are listed in `losses`; faces of fewer than three corners, values other than positions that
/// are not finite, and pictures that are missing in `warnings`. Cost: linear in the file's size, quadratic in the
/// corners of a concave polygon; the file's size, and about 60 bytes per triangle. Deterministic.
/// @throws IoError when the file can't be read; InvalidInput naming file, line (ASCII) or byte, and reason for
///         everything else.
/// Source: Turk, "The PLY Polygon File Format", 1994.
Scene read_ply(const std::filesystem::path& path, const ReadOptions& options = {});

/// Writes all instances of a scene as one binary little-endian PLY of triangles in millimetres and the scene's axes,
/// node transforms applied: 32-bit floats, colours as 8-bit sRGB. Positions stay shared: normals and colours are
/// written when they have one value at every position; texture coordinates then as s, t of the vertices, else as
/// MeshLab's texcoord of the faces; so are CAD (u,v), as cad_u, cad_v, or as a list cad_uv of the faces. The same scene
/// gives the same bytes; a failure leaves the old file as it was.
/// @returns what PLY has no place for, one sentence each.
/// @throws InvalidInput when a number is not finite as a 32-bit float or an index is out of range; IoError when writing
///         fails.
std::vector<std::string> write_ply(const Scene& scene, const std::filesystem::path& path);

/// Reads a binary or ASCII STL. Positions equal in every bit are merged, so the surface is connected where the file's
/// numbers agree; the file's facet normals are ignored, the winding counts. Degenerate triangles are kept.
///
/// A file whose size is 84 + 50·n for the n at byte 80 is binary, whatever its first word; so is a larger one
/// that does not begin with "solid" (a warning reports the surplus). ASCII: keywords in any case, any white space,
/// numbers with a decimal point whatever the locale; every solid becomes a part of its name.
/// Cost: linear, about 0.2 µs and 100 bytes per triangle. Deterministic.
/// @throws IoError when the file can't be read; InvalidInput naming the file and the triangle that is missing, not
/// finite
///         or (ASCII) the line that can't be understood.
Scene read_stl(const std::filesystem::path& path, const ReadOptions& options = {});

/// Writes all instances of a scene as one binary STL in millimetres and the scene's axes, node transforms applied
/// (mirrored instances keep their outside), facet normals from the corners. Binary STL knows no parts: all become one
/// surface, and where two parts touch in whole edges, these have more than two triangles; write a format with parts to
/// keep them apart. Names, materials, colours and uv have no place either. The same scene gives the same bytes; a
/// failure leaves the old file as it was.
/// @returns what has no place in STL, one sentence each.
/// @throws InvalidInput when a position is not finite as a 32-bit float or there are more than 2^32 − 1 triangles;
///         IoError when writing fails.
std::vector<std::string> write_stl(const Scene& scene, const std::filesystem::path& path);

}  // namespace papilla
