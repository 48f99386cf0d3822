// A shape with its numbered faces, edges and vertices (TopExp::MapShapes order).
#pragma once
#include "geometry.hxx"
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <memory>
#include <vector>

namespace occt {

struct FaceData;
struct EdgeData;
struct VertexData;
struct Coedge;

// The boundary of one face: its pcurves, wire by wire, in the order in which they connect.
class Loops {
public:
  explicit Loops(const TopoDS_Face& face, const TopTools_IndexedMapOfShape& edges);
  size_t count() const { return edges_.size(); }
  Coedge coedge(size_t i) const;
  std::unique_ptr<Pcurve> pcurve(size_t i) const;

private:
  void add_wire(const TopoDS_Shape& wire, const TopTools_IndexedMapOfShape& edges, int number);
  TopoDS_Face face_;
  struct Item {
    TopoDS_Shape edge;
    int index, wire;
  };
  std::vector<Item> edges_;
};

class Shape {
public:
  explicit Shape(const TopoDS_Shape& shape);
  const TopoDS_Shape& whole() const { return shape_; }
  size_t face_count() const { return faces_.Extent(); }
  size_t edge_count() const { return edges_.Extent(); }
  size_t vertex_count() const { return vertices_.Extent(); }
  FaceData face(size_t i) const;
  EdgeData edge(size_t i) const;
  VertexData vertex(size_t i) const;
  std::unique_ptr<Loops> loops(size_t face) const;
  std::unique_ptr<Surface> surface(size_t face) const;
  std::unique_ptr<Curve> curve(size_t edge) const;
  rust::Vec<uint8_t> bytes() const;
  const TopTools_IndexedMapOfShape& faces() const { return faces_; }
  const TopTools_IndexedMapOfShape& edges() const { return edges_; }
  const TopTools_IndexedMapOfShape& vertices() const { return vertices_; }

private:
  TopoDS_Shape shape_;
  TopTools_IndexedMapOfShape faces_, edges_, vertices_;
};

std::unique_ptr<Shape> shape_from_bytes(rust::Slice<const uint8_t> bytes);

} // namespace occt
