// MINFLUX (abberior) .json: an array of records with the fields of the .npy files. Classic files have one
// record a localisation with all its iterations as objects in itr (the last one is the final); newer ones one
// record an iteration with `fnl` marking the final one. Records are taken one by one, so that memory is the
// table's.
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "minflux.hpp"
#include "readers.hpp"
#include "smlm/error.hpp"

namespace smlm::readers {
namespace {

using nlohmann::json;

// No instrument's record comes near; a file that is one endless record is refused before it fills the memory.
constexpr std::size_t most_values_a_record = 100000;
constexpr int deepest = 8;

bool recognises(const FileHead& head) {
  const std::size_t start = head.bytes.find_first_not_of(" \t\r\n");
  if (head.hdf5 || start == std::string::npos || head.bytes[start] != '[') return false;
  return head.bytes.find("\"tid\"") != std::string::npos && head.bytes.find("\"loc\"") != std::string::npos;
}

std::optional<double> number(const json& object, const std::string& name) {
  const auto field = object.find(name);
  if (field == object.end()) return std::nullopt;
  if (field->is_boolean()) return field->get<bool>() ? 1.0 : 0.0;
  if (field->is_number()) return field->get<double>();
  return std::nullopt;
}

bool is_false(const json& record, const char* name) { return number(record, name).value_or(1) == 0; }

class Records {
 public:
  explicit Records(std::string path) : path_(std::move(path)) {}

  void add(const json& record) {
    ++row_;
    if (is_false(record, "fnl")) return;  // an earlier iteration
    if (is_false(record, "vld")) {
      if (rows_.invalid++ == 0) rows_.first_invalid = row_;
      return;
    }
    const auto iterations = record.find("itr");
    const bool nested = iterations != record.end() && iterations->is_array() && !iterations->empty();
    const json& measured = nested ? iterations->back() : record;
    const auto trace = number(record, "tid");
    const auto location = measured.is_object() ? measured.find("loc") : measured.end();
    if (!trace || location == measured.end() || !location->is_array()) fail();
    const std::size_t axes = location->size();
    if ((axes != 2 && axes != 3) || (!rows_.row.empty() && rows_.planar != (axes == 2))) fail();
    rows_.planar = axes == 2;
    std::array<double, 3> x{};
    for (std::size_t axis = 0; axis < axes; ++axis) {
      if (!(*location)[axis].is_number()) fail();
      x[axis] = (*location)[axis].get<double>();
    }
    rows_.location_m.push_back(x);
    rows_.trace.push_back(*trace);
    rows_.row.push_back(row_);
    if (rows_.row.size() == 1) name_extras(record, measured);
    for (ColumnArray& extra : rows_.extra) {
      const auto own = number(measured, extra.column.name);
      const auto value = own ? own : number(record, extra.column.name);
      extra.values.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
    }
  }

  MinfluxRows take() { return std::move(rows_); }

 private:
  // The first record decides which columns there are.
  void name_extras(const json& record, const json& measured) {
    const auto add_all = [&](const json& object) {
      for (const auto& [name, value] : object.items()) {
        if (!value.is_number() && !value.is_boolean()) continue;
        if (name != "tid" && name != "vld" && name != "fnl")
          rows_.extra.push_back({{name, "", Quantity::other}, {}});
      }
    };
    add_all(measured);
    if (&measured == &record) return;
    json outer = record;
    for (const auto& [name, value] : measured.items()) outer.erase(name);
    add_all(outer);
  }

  [[noreturn]] void fail() const {
    throw Error(
        Fault::input, path_,
        "record " + std::to_string(row_) + " has no tid or no loc of two or three numbers as in the others",
        "is it a MINFLUX table?");
  }

  std::string path_;
  std::uint64_t row_ = 0;
  MinfluxRows rows_;
};

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  std::ifstream file(path, std::ios::binary);
  Records records(path);
  std::size_t values = 0;
  const auto take = [&](int depth, json::parse_event_t event, json& parsed) {
    if (++values > most_values_a_record || depth > deepest)
      throw Error(Fault::input, path, "holds something that is no MINFLUX record", "export the table again");
    if (depth != 1 || event != json::parse_event_t::object_end) return true;
    records.add(parsed);
    values = 0;
    return false;  // it need not be kept
  };
  try {
    const json rest = json::parse(file, take);
    if (!rest.is_array() || !rest.empty())
      throw Error(Fault::input, path, "is not an array of records", "export the table again");
  } catch (const json::exception& e) {
    throw Error(Fault::input, path, std::string("is not JSON: ") + e.what(), "export or copy it again");
  }
  return build_minflux_table(path, records.take(), options);
}

}  // namespace

const TableReader minflux_json{"minflux_json", "MINFLUX / Imspector (.json)", recognises, read};

}  // namespace smlm::readers
