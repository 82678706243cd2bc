#include "fem/surface/foreign_format.hpp"

#include <algorithm>
#include <array>

namespace codesign::fem {
namespace {

constexpr std::size_t kLooked = 65536;  // bytes
constexpr const char* kExport = "export the part as STL from the program that wrote it";
constexpr const char* kConvert = "convert it to STL";
constexpr const char* kDownload = "the download failed or gave a page about the file";
constexpr const char* kUnpack = "unpack the STL file first";
constexpr const char* kNoShape = "choose the STL file of the part";

struct Format {
  std::string_view start;   // of the file
  std::string_view inside;  // somewhere in the first bytes
  const char* name;
  const char* remedy;
};

// The first that fits counts.
constexpr std::array kFormats = {
    Format{"ISO-10303-21", "", "a STEP file", "read it by load_step of codesign.fem.step"},
    Format{"PK\x03\x04", "3D/", "a 3MF file", kConvert},
    Format{"PK\x03\x04", "FreeCAD", "a FreeCAD document", kExport},
    Format{"PK\x03\x04", "Document.xml", "a FreeCAD document", kExport},
    Format{"PK\x03\x04", "", "a zip archive", kUnpack},
    Format{"\x1f\x8b", "", "compressed by gzip", kUnpack},
    Format{"7z\xbc\xaf", "", "a 7z archive", kUnpack},
    Format{"Rar!", "", "a RAR archive", kUnpack},
    Format{"ply\n", "", "a PLY file", kConvert},
    Format{"ply\r", "", "a PLY file", kConvert},
    Format{"glTF", "", "a GLB file (binary glTF)", kConvert},
    Format{"{", "\"asset\"", "a glTF file", kConvert},
    Format{"{", "", "a JSON text", kNoShape},
    Format{"OFF", "", "an OFF file", kConvert},
    Format{"<!DOCTYPE html", "", "a web page", kDownload},
    Format{"<html", "", "a web page", kDownload},
    Format{"<", "<html", "a web page", kDownload},
    Format{"version https://git-lfs", "", "a Git LFS pointer", "fetch the file by 'git lfs pull'"},
    Format{"<", "<COLLADA", "a COLLADA file", kConvert},
    Format{"<", "<amf", "an AMF file", kConvert},
    Format{"<", "<robot", "a robot description (URDF)", kNoShape},
    Format{"<", "<mujoco", "a robot description (MJCF)", kNoShape},
    Format{"<", "<svg", "an SVG drawing", kNoShape},
    Format{"<?xml", "", "an XML text", kNoShape},
    Format{"\xd0\xcf\x11\xe0", "", "a document of a CAD or office program", kExport},
    Format{"AC10", "", "a DWG drawing", kExport},
    Format{"DBRep_DrawableShape", "", "a BREP file of OpenCASCADE", kExport},
    Format{"CASCADE Topology", "", "a BREP file of OpenCASCADE", kExport},
    Format{"Kaydara FBX", "", "an FBX file", kConvert},
    Format{"; FBX", "", "an FBX file", kConvert},
    Format{"BLENDER", "", "a Blender file", kExport},
    Format{"#VRML", "", "a VRML file", kConvert},
    Format{"#X3D", "", "an X3D file", kConvert},
    Format{"# vtk", "", "a VTK file", kConvert},
    Format{"$MeshFormat", "", "a Gmsh mesh", kConvert},
    Format{"0", "SECTION", "a DXF drawing", kExport},
    Format{"%PDF", "", "a PDF document", kNoShape},
    Format{"\x89PNG", "", "a PNG picture", kNoShape},
    Format{"\xff\xd8\xff", "", "a JPEG picture", kNoShape},
};

constexpr char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }

bool same_letter(char a, char b) { return lower(a) == lower(b); }

bool begins_with(std::string_view text, std::string_view start) {
  return text.size() >= start.size() &&
         std::equal(start.begin(), start.end(), text.begin(), same_letter);
}

bool holds(std::string_view text, std::string_view word) {
  return std::search(text.begin(), text.end(), word.begin(), word.end(), same_letter) != text.end();
}

// Lines of vertices and faces behind comments: "v 0 0 1".
bool is_obj(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    for (const char* start : {"v ", "vn ", "vt ", "mtllib ", "o ", "g "})
      if (begins_with(line, start)) return holds(text, "\nv ") || begins_with(line, "v ");
    const bool skipped = line.empty() || line.front() == '#' || line == "\r";
    if (!skipped) return false;
    text.remove_prefix(std::min(text.size(), line.size() + 1));
  }
  return false;
}

// The first line of an IGES file is its start section, marked in column 73.
bool is_iges(std::string_view text) {
  return text.size() > 80 && text[72] == 'S' && text.substr(73, 7) == "      1";
}

}  // namespace

std::string foreign_format(std::string_view bytes) {
  std::string_view text = bytes.substr(0, kLooked);
  if (begins_with(text, "\xef\xbb\xbf")) text.remove_prefix(3);  // byte order mark
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  if (start == text.npos) return {};
  if (is_iges(text)) return std::string("an IGES file: ") + kExport;
  text.remove_prefix(start);
  for (const Format& format : kFormats)
    if (begins_with(text, format.start) && holds(text, format.inside))
      return std::string(format.name) + ": " + format.remedy;
  if (is_obj(text)) return std::string("an OBJ file: ") + kConvert;
  return {};
}

}  // namespace codesign::fem
