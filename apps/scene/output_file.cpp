#include "apps/scene/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <system_error>
#include <vector>

namespace limn::scene {
namespace {

constexpr mode_t kFileMode = 0666;  // less the process's umask

[[noreturn]] void fail(const std::string& path, const std::string& what, int error) {
  std::string remedy;
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      remedy = "; free some space or write elsewhere";
      break;
    case EACCES:
    case EPERM:
    case EROFS:
      remedy = "; choose a place that you may write to";
      break;
    case ENOENT:
    case ENOTDIR:
      remedy = "; is its directory still there?";
      break;
    default:
      break;
  }
  throw OutputError(path + ": " + what + ": " + std::generic_category().message(error) + remedy);
}

/// The temporary names in use. Signals belong to the process, so this does too.
struct TemporaryNames {
  std::mutex mutex;
  std::vector<std::string> names;
};
TemporaryNames& temporaryNames() {
  static TemporaryNames names;
  return names;
}

class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return descriptor_; }
  /// Network file systems report a full disk only here.
  int close() {
    const int result = ::close(descriptor_);
    descriptor_ = -1;
    return result;
  }

 private:
  int descriptor_;
};

/// A temporary name for a file beside its target; removed unless published.
class TemporaryName {
 public:
  /// `create` makes a file of the name that it is given, and says whether it could.
  template <class Create>
  TemporaryName(const std::string& target, const Create& create)
      : target_(target), name_(nameBeside(target)) {
    TemporaryNames& registry = temporaryNames();
    const std::lock_guard lock(registry.mutex);
    registry.names.push_back(name_);
    isThere_ = create(name_.c_str());
  }
  ~TemporaryName() {
    if (isThere_) ::unlink(name_.c_str());
    TemporaryNames& registry = temporaryNames();
    const std::lock_guard lock(registry.mutex);
    std::erase(registry.names, name_);
  }
  TemporaryName(const TemporaryName&) = delete;
  TemporaryName& operator=(const TemporaryName&) = delete;

  bool isThere() const { return isThere_; }

  /// Only rename replaces a file in one step.
  void publish() {
    if (::rename(name_.c_str(), target_.c_str()) != 0) fail(target_, "could not be put in place", errno);
    isThere_ = false;
  }

 private:
  /// ".NAME.limn-PID-COUNT" in the target's directory: hidden, and unlike any name that a pattern produces.
  static std::string nameBeside(const std::string& target) {
    static std::atomic<unsigned> count{0};
    const std::size_t slash = target.rfind('/');
    const std::size_t start = slash == std::string::npos ? 0 : slash + 1;
    return target.substr(0, start) + "." + target.substr(start, NAME_MAX - 40) + ".limn-" +
           std::to_string(::getpid()) + "-" + std::to_string(++count);
  }

  std::string target_, name_;
  bool isThere_ = false;
};

std::string directoryOf(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

/// Writes through a file that has no name until it is whole: a killed process leaves nothing behind. False
/// where the file system or the system has no such files.
bool writeThroughNameless(const std::string& path, const void* bytes, std::size_t count) {
  const Descriptor file(::open(directoryOf(path).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, kFileMode));
  if (file.get() < 0) return false;  // if the reason is another one, the named way will find it
  writeAll(file.get(), path, bytes, count);

  const std::string self = "/proc/self/fd/" + std::to_string(file.get());
  const auto linkAs = [&](const char* name) {
    return ::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0;
  };
  if (linkAs(path.c_str())) return true;
  if (errno != EEXIST) return false;
  TemporaryName name(path, linkAs);
  if (!name.isThere()) return false;
  name.publish();
  return true;
}

void writeThroughNamed(const std::string& path, const void* bytes, std::size_t count) {
  std::optional<Descriptor> file;
  TemporaryName name(path, [&file](const char* temporary) {
    file.emplace(::open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kFileMode));
    return file->get() >= 0;
  });
  if (!name.isThere()) fail(path, "cannot be created", errno);
  writeAll(file->get(), path, bytes, count);
  if (file->close() != 0) fail(path, "could not be written", errno);
  name.publish();
}

void writeToDevice(const std::string& path, const void* bytes, std::size_t count) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.get() < 0) fail(path, "cannot be opened for writing", errno);
  writeAll(file.get(), path, bytes, count);
  if (file.close() != 0) fail(path, "could not be written", errno);
}

/// The file that a symbolic link stands for, so that the link stays.
std::string linkTarget(const std::string& path) {
  const std::unique_ptr<char, decltype(&std::free)> resolved(::realpath(path.c_str(), nullptr), &std::free);
  return resolved ? std::string(resolved.get()) : path;
}

}  // namespace

void writeAll(int descriptor, const std::string& name, const void* bytes, std::size_t count) {
  const char* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = ::write(descriptor, next, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(name, "could not be written", errno);
    next += written;
    count -= static_cast<std::size_t>(written);
  }
}

namespace {

// What lies at `path` or where it links to; regular where nothing is there yet. Throws where no file can be.
mode_t modeToReplace(const std::string& path, std::string& target) {
  struct stat status {};
  target = path;
  if (::lstat(path.c_str(), &status) != 0) return S_IFREG | kFileMode;
  if (S_ISLNK(status.st_mode)) {
    target = linkTarget(path);
    if (::stat(target.c_str(), &status) != 0) return S_IFREG | kFileMode;  // the link leads nowhere yet
  }
  if (S_ISDIR(status.st_mode)) throw OutputError(path + ": is a directory; name a file in it");
  if (S_ISREG(status.st_mode) && (status.st_mode & 0222) == 0)
    throw OutputError(path +
                      ": is there already and read-only; remove it, make it writable or write elsewhere");
  return status.st_mode;
}

}  // namespace

void writeFileWhole(const std::string& path, const void* bytes, std::size_t count) {
  std::string target;
  if (!S_ISREG(modeToReplace(path, target))) return writeToDevice(target, bytes, count);
  if (!writeThroughNameless(target, bytes, count)) writeThroughNamed(target, bytes, count);
}

void requireWritable(const std::string& path) {
  std::string target;
  if (!S_ISREG(modeToReplace(path, target))) return;
  std::error_code ignored;
  std::filesystem::path directory = directoryOf(target);
  while (!std::filesystem::exists(directory, ignored) && directory.has_relative_path())
    directory = directory.has_parent_path() ? directory.parent_path() : ".";
  if (!std::filesystem::is_directory(directory, ignored)) fail(directory, "files cannot lie there", ENOTDIR);
  if (::access(directory.c_str(), W_OK) != 0) fail(directory, "nothing can be written there", errno);
}

void makeDirectoriesOf(const std::string& path) {
  const std::string directory = directoryOf(path);
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) fail(directory, "the directory cannot be made", error.value());
}

void abandonWrites() {
  TemporaryNames& registry = temporaryNames();
  registry.mutex.lock();  // for good: nobody makes another temporary file
  for (const std::string& name : registry.names) ::unlink(name.c_str());
}

}  // namespace limn::scene
