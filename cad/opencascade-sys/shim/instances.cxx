#include "instances.hxx"

#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Iterator.hxx>

namespace occt {
namespace {

void bind(const TopoDS_Shape& part, const std::string& path, Paths& paths) {
  for (const TopAbs_ShapeEnum kind : {TopAbs_FACE, TopAbs_EDGE, TopAbs_VERTEX}) {
    TopTools_IndexedMapOfShape members;
    TopExp::MapShapes(part, kind, members);
    for (int i = 1; i <= members.Extent(); i++)
      if (!paths.IsBound(members(i))) paths.Bind(members(i), path);
  }
}

void walk(const TopoDS_Shape& shape, const std::string& path, const std::vector<Instance>& instances, Paths& paths) {
  if (shape.ShapeType() != TopAbs_COMPOUND) {
    if (!path.empty()) bind(shape, path, paths);
    return;
  }
  // the same children twice: as they stand in the whole, and as they stand in their parent
  TopoDS_Iterator here(shape), local(shape, Standard_False, Standard_False);
  for (; here.More(); here.Next(), local.Next()) {
    std::string inner = path;
    for (const Instance& instance : instances) {
      if (!instance.shape.IsSame(local.Value())) continue;
      inner += (path.empty() ? "" : "/") + instance.name;
      break;
    }
    walk(here.Value(), inner, instances, paths);
  }
}

} // namespace

Paths paths_of(const TopoDS_Shape& whole, const std::vector<Instance>& instances) {
  Paths paths;
  if (!instances.empty()) walk(whole, "", instances, paths);
  return paths;
}

} // namespace occt
