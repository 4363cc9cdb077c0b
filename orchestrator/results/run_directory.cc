#include "orchestrator/results/run_directory.h"

#include <dirent.h>
#include <fcntl.h>
#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <ctime>
#include <system_error>

#include "common/posix/check.h"

namespace cuscus::orchestrator {
namespace {

using posix::check;
using posix::UniqueFd;

constexpr mode_t kFolderMode = 0755;
constexpr mode_t kFileMode = 0644;

std::tm utc(std::chrono::system_clock::time_point time) {
  return fmt::gmtime(std::chrono::system_clock::to_time_t(time));
}

/// A folder that need not be there, given to `owner` if it was made.
void make_folder(const std::filesystem::path& folder, std::optional<Owner> owner) {
  if (::mkdir(folder.c_str(), kFolderMode) != 0) {
    if (errno != EEXIST) {
      posix::throw_errno("mkdir");
    }
    return;
  }
  const UniqueFd made{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)};
  struct stat status {};
  // Unless somebody has put their own in its place meanwhile.
  if (owner && made && ::fstat(made.get(), &status) == 0 && status.st_uid == ::geteuid()) {
    static_cast<void>(::fchown(made.get(), owner->uid, owner->gid) == 0);
  }
}

void make_folders(const std::filesystem::path& path, std::optional<Owner> owner) {
  std::filesystem::path folder;
  for (const auto& part : path) {
    folder /= part;
    if (!std::filesystem::is_directory(folder)) {
      make_folder(folder, owner);
    }
  }
}

/// What is in the folder first: as long as it is ours, nobody can put something else in its place.
void give(int folder, Owner owner) noexcept {
  UniqueFd listed{::openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (DIR* const entries = listed ? ::fdopendir(listed.get()) : nullptr; entries != nullptr) {
    static_cast<void>(listed.release());  // closedir() closes it
    // The stream is this thread's alone. NOLINTNEXTLINE(concurrency-mt-unsafe)
    while (const dirent* const entry = ::readdir(entries)) {
      const char* const name = static_cast<const char*>(entry->d_name);
      if (std::string_view{name} == "." || std::string_view{name} == "..") {
        continue;
      }
      if (const UniqueFd inner{
              ::openat(folder, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)}) {
        give(inner.get(), owner);
      } else {
        static_cast<void>(::fchownat(folder, name, owner.uid, owner.gid, AT_SYMLINK_NOFOLLOW) == 0);
      }
    }
    static_cast<void>(::closedir(entries));
  }
  static_cast<void>(::fchown(folder, owner.uid, owner.gid) == 0);
}

/// Adds to an error what it was about.
template <typename Body>
auto naming(const std::string& what, Body&& body) {
  try {
    return body();
  } catch (const std::system_error& error) {
    throw std::system_error{error.code(), what};
  }
}

}  // namespace

std::string make_run_id(const std::string& scenario_name, std::chrono::system_clock::time_point now,
                        std::uint32_t random_bits) {
  return fmt::format("{}-{:%Y%m%dT%H%M%SZ}-{:06x}", scenario_name, utc(now),
                     random_bits & 0xffffffU);
}

std::string utc_text(std::chrono::system_clock::time_point time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", utc(time));
}

void write_all(int fd, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(fd, content.data(), content.size());
    if (written < 0 && errno == EINTR) {
      continue;
    }
    check("write", written);
    content.remove_prefix(static_cast<std::size_t>(written));
  }
}

RunDirectory RunDirectory::create(const std::filesystem::path& path,
                                  std::optional<Owner> parents_owner) {
  const std::filesystem::path absolute = std::filesystem::absolute(path).lexically_normal();
  // A trailing slash would leave no last part to make.
  const std::filesystem::path target = absolute.has_filename() ? absolute : absolute.parent_path();
  const std::string name = target.filename().string();
  return naming("make run directory " + target.string(), [&] {
    make_folders(target.parent_path(), parents_owner);
    const UniqueFd parent{check("open parent folder", ::open(target.parent_path().c_str(),
                                                             O_PATH | O_DIRECTORY | O_CLOEXEC))};
    // Fails with EEXIST on whatever is there, a symbolic link included.
    check("mkdirat", ::mkdirat(parent.get(), name.c_str(), kFolderMode));
    UniqueFd folder{check("open", ::openat(parent.get(), name.c_str(),
                                           O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC))};
    struct stat status {};
    check("fstat", ::fstat(folder.get(), &status));
    if (status.st_uid != ::geteuid()) {  // somebody put their own in its place meanwhile
      throw std::system_error{EPERM, std::system_category()};
    }
    check("mkdirat logs", ::mkdirat(folder.get(), std::string{kLogFolder}.c_str(), kFolderMode));
    return RunDirectory{target, std::move(folder)};
  });
}

void RunDirectory::write_file(const std::string& name, std::string_view content) const {
  const std::string temporary = name + ".part";
  naming("write " + (path_ / name).string(), [&] {
    const UniqueFd file{check(
        "create", ::openat(fd_.get(), temporary.c_str(),
                           O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, kFileMode))};
    try {
      write_all(file.get(), content);
      check("fsync", ::fsync(file.get()));
      check("rename", ::renameat(fd_.get(), temporary.c_str(), fd_.get(), name.c_str()));
    } catch (const std::system_error&) {
      static_cast<void>(::unlinkat(fd_.get(), temporary.c_str(), 0));
      throw;
    }
    check("fsync folder", ::fsync(fd_.get()));
  });
}

UniqueFd RunDirectory::create_file(const std::string& name) const {
  return naming("create " + (path_ / name).string(), [&] {
    return UniqueFd{check(
        "create",
        ::openat(fd_.get(), name.c_str(),
                 O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_NOFOLLOW | O_CLOEXEC, kFileMode))};
  });
}

UniqueFd RunDirectory::create_log(const std::string& name) const {
  return create_file(std::string{kLogFolder} + '/' + name);
}

void RunDirectory::create_folder(const std::string& name) const {
  naming("make folder " + (path_ / name).string(),
         [&] { check("mkdirat", ::mkdirat(fd_.get(), name.c_str(), kFolderMode)); });
}

void RunDirectory::give_to(Owner owner) const noexcept { give(fd_.get(), owner); }

}  // namespace cuscus::orchestrator
