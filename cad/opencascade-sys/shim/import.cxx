#include "import.hxx"
#include "guard.hxx"
#include "instances.hxx"
#include "place.hxx"
#include "opencascade-sys/src/lib.rs.h"

#include <BRepBuilderAPI_Transform.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <IGESBasic_Group.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <NCollection_DataMap.hxx>
#include <STEPConstruct_UnitContext.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Reader.hxx>
#if __has_include(<StepData_Factors.hxx>) // as of OCCT 7.8; 7.6 has none
#include <StepData_Factors.hxx>
#endif
#include <StepData_StepModel.hxx>
#include <StepGeom_CartesianPoint.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepRepr_GlobalUnitAssignedContext.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepGeom_SphericalSurface.hxx>
#include <StepGeom_ToroidalSurface.hxx>
#include <StepShape_FaceBound.hxx>
#include <StepShape_FaceSurface.hxx>
#include <StepShape_Loop.hxx>
#include <StepShape_VertexLoop.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TopExp.hxx>
#include <TopoDS_TShape.hxx>
#include <TransferBRep.hxx>
#include <Transfer_Binder.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <sstream>

namespace occt {
namespace {

void be_silent() { Message::DefaultMessenger()->ChangePrinters().Clear(); }

std::string text_of(const Handle(TCollection_HAsciiString)& text) { return text.IsNull() ? "" : text->ToCString(); }

// IGES labels are blank padded: "DUP     (7)" is DUP(7).
std::string trimmed(std::string text) {
  const size_t bracket = text.rfind('(');
  if (bracket != std::string::npos && bracket > 0 && text.back() == ')') {
    size_t end = bracket;
    while (end > 0 && text[end - 1] == ' ') end--;
    text = text.substr(0, end) + text.substr(bracket);
  }
  const size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

// rust::String refuses bytes that are not UTF-8; old files hold Latin-1.
rust::String lossy(const std::string& text) { return rust::String::lossy(text); }

struct Origin {
  std::string reference, name;
  int rank; // the smallest wins where several entities own one shape
};
using Origins = std::map<const TopoDS_TShape*, Origin>;

void remember(Origins& origins, const TopoDS_Shape& shape, Origin origin) {
  auto [it, fresh] = origins.try_emplace(shape.TShape().get(), origin);
  if (!fresh && origin.rank < it->second.rank) it->second = origin;
}

rust::Vec<Label> labels_of(const Shape& shape, const Origins& origins, const Paths& paths) {
  rust::Vec<Label> labels;
  const std::pair<int, const TopTools_IndexedMapOfShape*> kinds[] = {{0, &shape.faces()}, {1, &shape.edges()}, {2, &shape.vertices()}};
  for (const auto& [kind, map] : kinds)
    for (int i = 1; i <= map->Extent(); i++) {
      const auto it = origins.find((*map)(i).TShape().get());
      if (it == origins.end()) continue;
      Label label{};
      label.kind = uint8_t(kind);
      label.index = uint32_t(i - 1);
      const std::string* path = paths.Seek((*map)(i));
      label.reference = lossy(it->second.reference + (path ? "@" + *path : ""));
      label.name = lossy(it->second.name);
      labels.push_back(label);
    }
  return labels;
}

// Named sets of the file: each becomes labels of kind 3 (faces) and 4 (edges that bound none of those) that share a name.
void add_group(rust::Vec<Label>& labels, const Shape& shape, const TopoDS_Shape& group, const std::string& reference, const std::string& name) {
  TopTools_IndexedMapOfShape faces, edges, sides;
  TopExp::MapShapes(group, TopAbs_FACE, faces);
  TopExp::MapShapes(group, TopAbs_EDGE, edges);
  for (int i = 1; i <= faces.Extent(); i++) TopExp::MapShapes(faces(i), TopAbs_EDGE, sides);
  const auto add = [&](int kind, int number) {
    if (number == 0) return;
    Label label{};
    label.kind = uint8_t(kind);
    label.index = uint32_t(number - 1);
    label.reference = lossy(reference);
    label.name = lossy(name);
    labels.push_back(label);
  };
  for (int i = 1; i <= faces.Extent(); i++) add(3, shape.faces().FindIndex(faces(i)));
  for (int i = 1; i <= edges.Extent(); i++)
    if (!sides.Contains(edges(i))) add(4, shape.edges().FindIndex(edges(i)));
}

TopoDS_Shape scaled_by(const TopoDS_Shape& shape, double factor) {
  if (factor == 1) return shape;
  gp_Trsf scale;
  scale.SetScale(gp_Pnt(0, 0, 0), factor);
  BRepBuilderAPI_Transform transform(shape, scale, Standard_True);
  return transform.Shape();
}

struct Source {
  TopoDS_Shape shape;
  std::string unit = "unknown";
  double millimetres = 1;
  Origins origins;
  std::vector<Instance> instances;
  std::vector<std::tuple<TopoDS_Shape, std::string, std::string>> groups;
  rust::Vec<rust::String> dropped, warnings;
  bool announces = false;
};

void check_status(IFSelect_ReturnStatus status) {
  if (status == IFSelect_RetDone) return;
  throw std::runtime_error(status == IFSelect_RetVoid ? "the file holds nothing" : "the file cannot be parsed (truncated or not of this format?)");
}

std::string step_id(const Handle(StepData_StepModel)& model, const Handle(Standard_Transient)& entity) {
  const int id = model->IdentLabel(entity);
  return "step:#" + std::to_string(id > 0 ? id : model->Number(entity));
}

// 0 for a name that is not known.
double millimetres_of(std::string name) {
  for (char& c : name) c = char(std::tolower(static_cast<unsigned char>(c)));
  static const std::map<std::string, double> known = {
      {"metre", 1000}, {"meter", 1000}, {"m", 1000}, {"millimetre", 1}, {"millimeter", 1}, {"mm", 1},
      {"centimetre", 10}, {"centimeter", 10}, {"cm", 10}, {"decimetre", 100}, {"decimeter", 100},
      {"micrometre", 1e-3}, {"micrometer", 1e-3}, {"micron", 1e-3}, {"nanometre", 1e-6}, {"kilometre", 1e6}, {"kilometer", 1e6},
      {"inch", 25.4}, {"in", 25.4}, {"inches", 25.4}, {"foot", 304.8}, {"ft", 304.8}, {"feet", 304.8}, {"mil", 0.0254}, {"mile", 1609344}, {"yard", 914.4}};
  const auto it = known.find(name);
  return it == known.end() ? 0 : it->second;
}

// The units of a context, which is nearly always one of the two complex entities.
Handle(StepRepr_GlobalUnitAssignedContext) units_of(const Handle(Standard_Transient)& entity) {
  const auto full = Handle(StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx)::DownCast(entity);
  if (!full.IsNull()) return full->GlobalUnitAssignedContext();
  const auto geometric = Handle(StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext)::DownCast(entity);
  if (!geometric.IsNull()) return geometric->GlobalUnitAssignedContext();
  return Handle(StepRepr_GlobalUnitAssignedContext)::DownCast(entity);
}

void read_step_unit(const Handle(StepData_StepModel)& model, STEPControl_Reader& reader, Source& source) {
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  if (lengths.Length() > 0) source.unit = lengths(1).ToCString();
  source.millimetres = millimetres_of(source.unit);
  if (source.millimetres > 0) return;
  // a unit that only its conversion factor describes
  for (int i = 1; i <= model->NbEntities(); i++) {
    const auto context = units_of(model->Value(i));
    if (context.IsNull()) continue;
    STEPConstruct_UnitContext units;
#if __has_include(<StepData_Factors.hxx>)
    units.ComputeFactors(context, StepData_Factors()); // to millimetres
#else
    units.ComputeFactors(context);
#endif
    if (units.LengthDone() && units.LengthFactor() > 0) source.millimetres = units.LengthFactor();
  }
  if (source.millimetres <= 0) throw std::runtime_error("unknown unit of length: " + source.unit);
}

// Warns of an entity before it is transferred. A child does so on the error stream too: should OCCT crash on it, the parent still learns of it.
void warn(Source& source, const std::string& reference, const std::string& cause) {
  const std::string text = reference + ": " + cause;
  if (source.announces && source.warnings.size() < 100) std::cerr << "sagitta-warning " << text << std::endl;
  source.warnings.push_back(lossy(text));
}

// What OCCT's own check of the model calls a failure.
template <class Reader, class Name> void warn_of_fails(Reader& reader, Source& source, Name name) {
  Interface_CheckIterator checks = reader.WS()->ModelCheckList(Standard_True);
  for (checks.Start(); checks.More(); checks.Next()) {
    const Handle(Interface_Check) check = checks.Value();
    if (check.IsNull() || !check->HasFailed()) continue;
    const Handle(Standard_Transient) entity = checks.Number() > 0 ? reader.WS()->Model()->Value(checks.Number()) : Handle(Standard_Transient)();
    warn(source, entity.IsNull() ? "the file" : name(entity), check->CFail(1));
  }
}

// The identifier of a usage in an assembly, else its number in the file.
std::string instance_name(const Handle(StepData_StepModel)& model, const Handle(StepRepr_NextAssemblyUsageOccurrence)& usage) {
  const std::string id = text_of(usage->Id());
  return id.empty() ? "#" + std::to_string(model->IdentLabel(usage)) : id;
}

// OCCT takes an overflowing number for infinity, and may search without end then.
void refuse_infinite(const Handle(StepData_StepModel)& model, const Handle(Standard_Transient)& entity) {
  const auto point = Handle(StepGeom_CartesianPoint)::DownCast(entity);
  if (point.IsNull()) return;
  for (int i = 1; i <= point->NbCoordinates(); i++)
    if (!std::isfinite(point->CoordinatesValue(i))) throw std::runtime_error(step_id(model, entity) + ": coordinate " + std::to_string(i) + " is not a finite number");
}

// Whether a face has vertex loops for all its bounds, on a surface that is not closed by itself: OCCT takes the range that the surface came with.
bool is_bounded_by_a_vertex(const Handle(Standard_Transient)& entity) {
  const auto face = Handle(StepShape_FaceSurface)::DownCast(entity);
  if (face.IsNull() || face->Bounds().IsNull() || face->FaceGeometry().IsNull()) return false;
  if (face->FaceGeometry()->IsKind(STANDARD_TYPE(StepGeom_SphericalSurface)) || face->FaceGeometry()->IsKind(STANDARD_TYPE(StepGeom_ToroidalSurface))) return false;
  for (int i = 1; i <= face->NbBounds(); i++) {
    const Handle(StepShape_FaceBound) bound = face->BoundsValue(i);
    if (bound.IsNull() || bound->Bound().IsNull() || !bound->Bound()->IsKind(STANDARD_TYPE(StepShape_VertexLoop))) return false;
  }
  return face->NbBounds() > 0;
}

void read_step(const std::string& path, Source& source) {
  STEPControl_Controller::Init();
  STEPControl_Reader reader;
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  check_status(reader.ReadFile(path.c_str()));
  Handle(StepData_StepModel) model = Handle(StepData_StepModel)::DownCast(reader.WS()->Model());
  for (int i = 1; i <= model->NbEntities(); i++) {
    if (model->IsErrorEntity(i) || model->IsRedefinedContent(i))
      warn(source, step_id(model, model->Value(i)), std::string("malformed ") + model->Value(i)->DynamicType()->Name());
    else refuse_infinite(model, model->Value(i));
    if (is_bounded_by_a_vertex(model->Value(i)))
      warn(source, step_id(model, model->Value(i)), "a face that is bounded by a vertex alone is taken for all of its surface");
  }
  warn_of_fails(reader, source, [&](const Handle(Standard_Transient)& entity) { return step_id(model, entity); });
  reader.TransferRoots();
  source.shape = reader.OneShape();
  read_step_unit(model, reader, source);
  Handle(Transfer_TransientProcess) process = reader.WS()->TransferReader()->TransientProcess();
  for (int i = 1; i <= process->NbMapped(); i++) {
    Handle(Standard_Transient) entity = process->Mapped(i);
    auto item = Handle(StepRepr_RepresentationItem)::DownCast(entity);
    Handle(Transfer_Binder) binder = process->MapItem(i);
    const TopoDS_Shape shape = binder.IsNull() ? TopoDS_Shape() : TransferBRep::ShapeResult(binder);
    if (shape.IsNull()) {
      if (entity->IsKind(STANDARD_TYPE(StepShape_FaceSurface))) source.dropped.push_back(lossy(step_id(model, entity)));
      continue;
    }
    auto usage = Handle(StepRepr_NextAssemblyUsageOccurrence)::DownCast(entity);
    if (!usage.IsNull()) source.instances.push_back({shape, instance_name(model, usage)});
    if (!item.IsNull()) remember(source.origins, shape, {step_id(model, entity), text_of(item->Name()), 0});
  }
}

int iges_rank(int type) { return type == 144 || type == 143 || type == 510 || type == 504 ? 0 : type == 128 ? 2 : 1; }

void read_iges_groups(const Handle(IGESData_IGESModel)& model, const Handle(Transfer_TransientProcess)& process, Source& source) {
  for (int i = 1; i <= process->NbMapped(); i++) {
    auto entity = Handle(IGESData_IGESEntity)::DownCast(process->Mapped(i));
    if (entity.IsNull() || entity->TypeNumber() != 402) continue;
    Handle(Transfer_Binder) binder = process->MapItem(i);
    const TopoDS_Shape shape = binder.IsNull() ? TopoDS_Shape() : TransferBRep::ShapeResult(binder);
    if (shape.IsNull()) continue;
    source.groups.emplace_back(shape, "iges:D" + std::to_string(model->DNum(entity)), trimmed(text_of(entity->NameValue())));
  }
}

void read_iges(const std::string& path, Source& source) {
  IGESControl_Controller::Init();
  IGESControl_Reader reader;
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  check_status(reader.ReadFile(path.c_str()));
  Handle(IGESData_IGESModel) model = Handle(IGESData_IGESModel)::DownCast(reader.WS()->Model());
  warn_of_fails(reader, source, [&](const Handle(Standard_Transient)& entity) {
    return "iges:D" + std::to_string(model->DNum(Handle(IGESData_IGESEntity)::DownCast(entity)));
  });
  reader.TransferRoots();
  if (reader.NbShapes() == 0) throw std::runtime_error("the file holds no shape (truncated or empty?)");
  source.shape = reader.OneShape();
  source.unit = text_of(model->GlobalSection().UnitName());
  source.millimetres = model->GlobalSection().UnitValue();
  Handle(Transfer_TransientProcess) process = reader.WS()->TransferReader()->TransientProcess();
  for (int i = 1; i <= process->NbMapped(); i++) {
    auto entity = Handle(IGESData_IGESEntity)::DownCast(process->Mapped(i));
    if (entity.IsNull()) continue;
    const std::string reference = "iges:D" + std::to_string(model->DNum(entity));
    Handle(Transfer_Binder) binder = process->MapItem(i);
    const TopoDS_Shape shape = binder.IsNull() ? TopoDS_Shape() : TransferBRep::ShapeResult(binder);
    const int type = entity->TypeNumber();
    if (shape.IsNull()) {
      if (type == 144 || type == 143 || type == 510) source.dropped.push_back(lossy(reference));
      continue;
    }
    if (type != 402) remember(source.origins, shape, {reference, trimmed(text_of(entity->NameValue())), iges_rank(type)});
  }
  read_iges_groups(model, process, source);
}

void read_brep(const std::string& path, Source& source) {
  std::ifstream input(path, std::ios::binary);
  if (!input) throw std::runtime_error("the file cannot be opened");
  // OCCT says little of what is wrong; where it stood when it gave up is told.
  const auto where = [&] {
    input.clear();
    const auto end = input.tellg();
    input.seekg(0);
    std::streamoff lines = 1;
    for (std::streamoff at = 0; at < end && input; at++) lines += input.get() == '\n';
    return "line " + std::to_string(lines) + ": ";
  };
  BRep_Builder builder;
  const Standing standing(input.rdbuf(), path.c_str());
  try {
    BRepTools::Read(source.shape, input, builder);
  } catch (const Standard_Failure& failure) {
    const std::string cause = failure.GetMessageString();
    throw std::runtime_error(where() + (cause.empty() ? "the file cannot be parsed as BREP" : cause));
  }
  if (source.shape.IsNull()) throw std::runtime_error(where() + "the file cannot be parsed as BREP");
}

} // namespace

Import::Import(std::unique_ptr<Shape> shape, std::string unit, double scale, rust::Vec<Label> labels, rust::Vec<rust::String> dropped,
               rust::Vec<rust::String> warnings)
    : shape_(std::move(shape)), unit_(std::move(unit)), millimetres_(scale), labels_(std::move(labels)), dropped_(std::move(dropped)), warnings_(std::move(warnings)) {}

rust::Vec<Label> Import::labels() const { return labels_; }

std::unique_ptr<Import> read_file(rust::Str name, Format format, double scale, bool announce) {
  return guard("reading", [&] {
    be_silent();
    const std::string path(name);
    Source source;
    source.announces = announce;
    if (format == Format::Step) read_step(path, source);
    else if (format == Format::Iges) read_iges(path, source);
    else read_brep(path, source);
    if (source.shape.IsNull()) throw std::runtime_error("no shape came out of it");
    const Shape read(source.shape);
    rust::Vec<Label> labels = labels_of(read, source.origins, paths_of(source.shape, source.instances));
    for (const auto& [shape, reference, title] : source.groups) add_group(labels, read, shape, reference, title);
    auto scaled = std::make_unique<Shape>(scaled_by(source.shape, scale / source.millimetres));
    if (scaled->face_count() != read.face_count() || scaled->edge_count() != read.edge_count())
      throw std::runtime_error("scaling to the unit of the file changed the topology");
    return std::make_unique<Import>(std::move(scaled), source.unit, source.millimetres, std::move(labels), std::move(source.dropped), std::move(source.warnings));
  });
}

} // namespace occt
