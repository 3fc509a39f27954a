#include "mat_v5.hpp"

#include <matio.h>

#include <filesystem>
#include <limits>
#include <memory>

#include "smlm/error.hpp"

namespace smlm {
namespace {

constexpr int deepest = 6;
// A damaged file can claim any number of axes or cells, and libmatio walks them all.
constexpr int most_axes = 8;
constexpr std::size_t most_cells = 1'000'000;

struct CloseFile {
  void operator()(mat_t* file) const { Mat_Close(file); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using MatFile = std::unique_ptr<mat_t, CloseFile>;
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

void silence(int, char*) {}

MatFile open(const std::string& path) {
  Mat_LogInitFunc("smlm", silence);
  return MatFile(Mat_Open(path.c_str(), MAT_ACC_RDONLY));
}

template <class T>
std::vector<double> convert(const matvar_t* variable, std::size_t elements) {
  std::vector<double> numbers;
  if (elements > variable->nbytes / sizeof(T)) return numbers;  // dimensions that the data do not fill
  const T* values = static_cast<const T*>(variable->data);
  numbers.reserve(elements);
  for (std::size_t i = 0; i < elements; ++i) numbers.push_back(static_cast<double>(values[i]));
  return numbers;
}

std::vector<double> numbers_of(const matvar_t* variable, std::size_t elements) {
  switch (variable->data_type) {
    case MAT_T_DOUBLE:
      return convert<double>(variable, elements);
    case MAT_T_SINGLE:
      return convert<float>(variable, elements);
    case MAT_T_INT8:
      return convert<std::int8_t>(variable, elements);
    case MAT_T_UINT8:
      return convert<std::uint8_t>(variable, elements);
    case MAT_T_INT16:
      return convert<std::int16_t>(variable, elements);
    case MAT_T_UINT16:
      return convert<std::uint16_t>(variable, elements);
    case MAT_T_INT32:
      return convert<std::int32_t>(variable, elements);
    case MAT_T_UINT32:
      return convert<std::uint32_t>(variable, elements);
    case MAT_T_INT64:
      return convert<std::int64_t>(variable, elements);
    case MAT_T_UINT64:
      return convert<std::uint64_t>(variable, elements);
    default:
      return {};
  }
}

std::size_t elements_of(const matvar_t* variable) {
  std::size_t elements = 1;
  for (int axis = 0; axis < variable->rank; ++axis) {
    const std::size_t extent = variable->dims[axis];
    if (extent != 0 && elements > std::numeric_limits<std::size_t>::max() / extent) return 0;
    elements *= extent;
  }
  return elements;
}

// More values than the file can hold even if each were one byte, deflated at the best possible ratio.
std::size_t deflated_most(const std::string& path) {
  constexpr std::uintmax_t max_deflate_ratio = 1032;
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  return error ? 0 : static_cast<std::size_t>(bytes * max_deflate_ratio);
}

MatValue value_of(matvar_t* variable, std::size_t most_elements, int depth) {
  MatValue value;
  if (variable == nullptr || variable->data == nullptr || variable->dims == nullptr || depth > deepest)
    return value;
  const std::size_t elements = elements_of(variable);
  if (elements > most_elements) return value;
  value.dims.assign(variable->dims, variable->dims + variable->rank);
  if (variable->class_type == MAT_C_CELL) {
    if (elements > most_cells || elements > variable->nbytes / sizeof(matvar_t*)) return value;
    value.kind = MatValue::Kind::cells;
    for (std::size_t i = 0; i < elements; ++i) {
      value.cells.push_back(
          value_of(Mat_VarGetCell(variable, static_cast<int>(i)), most_elements, depth + 1));
    }
  } else if (variable->class_type == MAT_C_STRUCT) {
    if (elements != 1) return value;
    value.kind = MatValue::Kind::structure;
    char* const* names = Mat_VarGetStructFieldnames(variable);
    const unsigned count = Mat_VarGetNumberOfFields(variable);
    for (unsigned i = 0; names != nullptr && i < count; ++i) {
      if (names[i] == nullptr) continue;
      value.fields.emplace(names[i],
                           value_of(Mat_VarGetStructFieldByIndex(variable, i, 0), most_elements, depth + 1));
    }
  } else if (variable->isComplex == 0) {
    value.numbers = numbers_of(variable, elements);
    if (value.numbers.size() == elements) value.kind = MatValue::Kind::numbers;
  }
  return value;
}

}  // namespace

const MatValue& MatValue::field(const std::string& name) const {
  static const MatValue none;
  const auto found = fields.find(name);
  return found == fields.end() ? none : found->second;
}

bool is_mat_v5(const std::string& beginning) { return beginning.compare(0, 19, "MATLAB 5.0 MAT-file") == 0; }

std::vector<std::string> mat_v5_variables(const std::string& path) {
  std::vector<std::string> names;
  const MatFile file = open(path);
  if (!file) return names;
  while (const Variable variable{Mat_VarReadNextInfo(file.get())}) {
    if (variable->name != nullptr) names.emplace_back(variable->name);
    if (names.size() > 1000) break;
  }
  return names;
}

MatValue read_mat_v5(const std::string& path, const std::string& name) {
  const MatFile file = open(path);
  if (!file)
    throw Error(Fault::input, path, "cannot be opened as a MATLAB 5 file (truncated or damaged?)",
                "save it again");
  const Variable variable(Mat_VarRead(file.get(), name.c_str()));
  if (!variable)
    throw Error(Fault::input, path, "its variable '" + name + "' cannot be read", "save it again");
  return value_of(variable.get(), deflated_most(path), 0);
}

}  // namespace smlm
