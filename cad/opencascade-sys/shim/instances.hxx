// Which instance of an assembly a face, edge or vertex belongs to.
#pragma once
#include <NCollection_DataMap.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

namespace occt {

// An instance: its shape as it stands in its parent, and its name.
struct Instance {
  TopoDS_Shape shape;
  std::string name;
};

// Path of instances, "outer/inner", of every face, edge and vertex of a shape that has one.
using Paths = NCollection_DataMap<TopoDS_Shape, std::string, TopTools_ShapeMapHasher>;
Paths paths_of(const TopoDS_Shape& whole, const std::vector<Instance>& instances);

} // namespace occt
