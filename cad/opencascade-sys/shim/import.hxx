// Reading a file with OCCT: shape, unit, names and references, what was dropped.
#pragma once
#include "shape.hxx"
#include <string>

namespace occt {

enum class Format : uint8_t;
struct Label;

class Import {
public:
  Import(std::unique_ptr<Shape> shape, std::string unit, double scale, rust::Vec<Label> labels, rust::Vec<rust::String> dropped,
         rust::Vec<rust::String> warnings);
  const Shape& shape() const { return *shape_; }
  rust::String unit() const { return unit_; }
  double millimetres_per_unit() const { return millimetres_; }
  rust::Vec<Label> labels() const;
  rust::Vec<rust::String> dropped() const { return dropped_; }
  rust::Vec<rust::String> warnings() const { return warnings_; }

private:
  std::unique_ptr<Shape> shape_;
  std::string unit_;
  double millimetres_;
  rust::Vec<Label> labels_;
  rust::Vec<rust::String> dropped_, warnings_;
};

// Coordinates come in the unit of the file times `scale`.
std::unique_ptr<Import> read_file(rust::Str path, Format format, double scale, bool announce);

} // namespace occt
