// Owns one HDF5 identifier of any kind, and the state behind h5::File.
#pragma once

#include <hdf5.h>

#include <new>
#include <set>
#include <string>
#include <utility>

#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"

namespace smlm::h5 {

class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close closer) : id_(id), close_(closer) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0 && close_ != nullptr) close_(id_);
  }
  hid_t get() const { return id_; }
  bool valid() const { return id_ >= 0; }
  /// Closes now and says whether that worked.
  bool close() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// Whether the call that has just failed did so because it got no memory.
bool out_of_memory();

struct File::State {
  std::string path;
  Limits limits;
  std::uint64_t file_bytes = 0;
  bool writable = false;
  Handle file;
  mutable std::set<std::string> acceptable;  // data sets of a file that is only read, once looked at

  [[noreturn]] void fail_input(const std::string& object, const std::string& what,
                               const std::string& remedy = {}) const {
    if (writable) fail_io(object, what);  // what we are writing cannot be somebody's damaged file
    throw Error(Fault::input, path + ":" + object, what, remedy);
  }
  [[noreturn]] void fail_io(const std::string& object, const std::string& what) const {
    if (out_of_memory()) throw std::bad_alloc();
    throw Error(Fault::io, path + ":" + object, what, "check that the disk has space and answers");
  }

  /// Whether every step of `object` is a hard link to something that exists; a soft, external or
  /// user-defined link on the way is an error, because following it could open another file.
  bool resolves(const std::string& object) const;
  Handle open_object(const std::string& object) const;
  /// The data set, once its layout, filters and sizes have been found acceptable.
  Handle open_dataset(const std::string& dataset) const;
  DatasetInfo info(const std::string& dataset) const;
  void make_parents(const std::string& object) const;
  void check_bytes(const std::string& dataset, std::uint64_t elements, std::size_t element_bytes) const;
  Handle create_dataset(const std::string& dataset, hid_t type, hid_t space, hid_t properties) const;
};

hid_t native_type(Scalar scalar);
/// "/a/b/c" -> "/a/b"; the parent of a top-level object is "/".
std::string parent_of(const std::string& object);
/// Saves the process from HDF5's own error prints and from filter plugins; called before any other use.
void initialise();

}  // namespace smlm::h5
