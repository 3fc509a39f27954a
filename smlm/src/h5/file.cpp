// Opening, creating, closing, links and groups.
#include "smlm/h5/file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "handle.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/regular_file.hpp"

namespace smlm::h5 {
namespace {

constexpr std::array<unsigned char, 8> signature{0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};

bool locked_by_another(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool locked = ::flock(fd, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(fd);
  return locked;
}

Handle access_properties() {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // Raw data caches per data set: enough for a row of chunks, and bounded however many are opened.
  H5Pset_cache(access.get(), 0, 521, 4 << 20, 0.75);
  H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
  // Network file systems without locks are read without; HDF5_USE_FILE_LOCKING=FALSE overrides any lock.
  H5Pset_file_locking(access.get(), 1, 1);
  return access;
}

// HDF5 1.10 crashes, or ends the program, where it gets no memory: what a step needs is asked for
// beforehand, from those who say so.
void require_memory() {
  constexpr std::size_t step_bytes = 16 << 20;  // caches, conversion and filters of one data set
  ::operator delete(::operator new(step_bytes));
}

herr_t find_no_space(unsigned, const H5E_error2_t* error, void* found) {
  if (error->min_num == H5E_NOSPACE || error->min_num == H5E_CANTALLOC) *static_cast<bool*>(found) = true;
  return 0;
}

herr_t collect_name(hid_t, const char* name, const H5L_info_t* info, void* out) {
  auto& entries = *static_cast<std::vector<std::pair<std::string, H5L_type_t>>*>(out);
  entries.emplace_back(name, info->type);
  return 0;
}

}  // namespace

bool out_of_memory() {
  bool found = false;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, find_no_space, &found);
  return found;
}

void initialise() {
  // First of all calls, or it has no effect: a file whose last bytes could not be written stays half closed,
  // and HDF5 1.10 crashes on it when the program ends. Every file is closed by its owner anyway.
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5PLset_loading_state(0);
}

// A new file at `path`; messages call it `shown`.
static std::unique_ptr<File::State> created(const std::string& path, const std::string& shown) {
  require_memory();
  initialise();
  auto state = std::make_unique<File::State>();
  state->path = shown;
  state->writable = true;
  const Handle access = access_properties();
  state->file = Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose);
  if (!state->file.valid()) {
    if (out_of_memory()) throw std::bad_alloc();
    throw Error(Fault::io, shown, "cannot be created",
                "check the folder, its permissions and the disk's space");
  }
  return state;
}

std::string parent_of(const std::string& object) {
  const auto slash = object.rfind('/');
  return slash == 0 || slash == std::string::npos ? "/" : object.substr(0, slash);
}

File::File(std::unique_ptr<State> state) : state_(std::move(state)) {}
File::File(File&&) noexcept = default;
File& File::operator=(File&&) noexcept = default;
File::~File() = default;

const std::string& File::path() const { return state_->path; }

bool File::is_hdf5(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  // The superblock stands at 0 or behind a user block of 512, 1024, 2048, ... bytes.
  for (std::streamoff offset = 0; file && offset <= 1 << 16; offset = offset == 0 ? 512 : 2 * offset) {
    std::array<char, 8> bytes{};
    file.seekg(offset);
    if (file.read(bytes.data(), 8) && std::memcmp(bytes.data(), signature.data(), 8) == 0) return true;
  }
  return false;
}

File File::open(const std::string& path, const Limits& limits) {
  require_memory();
  initialise();
  auto state = std::make_unique<State>();
  state->path = path;
  state->limits = limits;
  state->file_bytes = require_regular_file(path);
  const Handle access = access_properties();
  state->file = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
  if (!state->file.valid()) {
    if (::access(path.c_str(), R_OK) != 0)
      throw Error(Fault::io, path, std::strerror(errno), "check the permissions");
    if (locked_by_another(path)) {
      throw Error(Fault::io, path, "is locked by another program that writes it",
                  "close that program, or set HDF5_USE_FILE_LOCKING=FALSE if the lock is stale");
    }
    throw Error(Fault::input, path,
                is_hdf5(path)
                    ? "starts like HDF5 but cannot be opened (truncated, damaged or still being written)"
                    : "is not an HDF5 file",
                "write or copy it again");
  }
  return File(std::move(state));
}

File File::create(const std::string& path) { return File(created(path, path)); }

File File::create(const AtomicFile& atomic) {
  return File(created(atomic.temporary_path(), atomic.final_path()));
}

void File::close() {
  const bool flushed = !state_->writable || H5Fflush(state_->file.get(), H5F_SCOPE_GLOBAL) >= 0;
  if (!state_->file.close() || !flushed) {
    throw Error(Fault::io, state_->path, "the last bytes could not be written",
                "check that the disk has space");
  }
}

bool File::State::resolves(const std::string& object) const {
  require_memory();  // every step begins here
  if (object.empty() || object.front() != '/') fail_input(object, "is not an absolute path in the file");
  if (object == "/") return true;
  for (auto slash = object.find('/', 1);; slash = object.find('/', slash + 1)) {
    const std::string step = object.substr(0, slash);
    if (H5Lexists(file.get(), step.c_str(), H5P_DEFAULT) <= 0) return false;
    H5L_info_t link{};
    if (H5Lget_info(file.get(), step.c_str(), &link, H5P_DEFAULT) < 0)
      fail_input(step, "its link cannot be read");
    if (link.type != H5L_TYPE_HARD) {
      fail_input(step, "is a soft or external link, which is never followed", "copy the data into the file");
    }
    if (slash == std::string::npos) return true;
  }
}

Handle File::State::open_object(const std::string& object) const {
  if (!resolves(object)) fail_input(object, "does not exist");
  Handle handle(H5Oopen(file.get(), object.c_str(), H5P_DEFAULT), H5Oclose);
  if (!handle.valid()) fail_input(object, "cannot be opened (damaged?)");
  return handle;
}

bool File::exists(const std::string& object) const { return state_->resolves(object); }

bool File::is_dataset(const std::string& object) const {
  return state_->resolves(object) && H5Iget_type(state_->open_object(object).get()) == H5I_DATASET;
}

std::vector<Entry> File::list(const std::string& group) const {
  const Handle handle = state_->open_object(group);
  H5G_info_t info{};
  if (H5Gget_info(handle.get(), &info) < 0) state_->fail_input(group, "is not a group");
  if (info.nlinks > state_->limits.max_objects_per_group) {
    throw Error(Fault::resource, state_->path + ":" + group,
                "holds " + std::to_string(info.nlinks) + " objects, more than will be listed");
  }
  std::vector<std::pair<std::string, H5L_type_t>> links;
  if (H5Literate(handle.get(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, collect_name, &links) < 0) {
    state_->fail_input(group, "its members cannot be listed (damaged?)");
  }
  std::vector<Entry> entries;
  for (const auto& [name, type] : links) {
    if (type != H5L_TYPE_HARD) continue;  // links that could lead elsewhere do not exist for us
    H5O_info_t object{};
    if (H5Oget_info_by_name1(handle.get(), name.c_str(), &object, H5P_DEFAULT) < 0) {
      state_->fail_input(group, "member '" + name + "' cannot be read (damaged?)");
    }
    entries.push_back({name, object.type == H5O_TYPE_GROUP});
  }
  return entries;
}

void File::make_group(const std::string& group) {
  if (state_->resolves(group)) return;
  make_group(parent_of(group));
  const Handle handle(H5Gcreate2(state_->file.get(), group.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                      H5Gclose);
  if (!handle.valid()) state_->fail_io(group, "the group cannot be created");
}

}  // namespace smlm::h5
