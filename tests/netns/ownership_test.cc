// Whatever happens to the process that owns a fleet, nothing of the fleet outlives it.
#include <fcntl.h>
#include <net/if.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "common/posix/check.h"
#include "common/posix/child_process.h"
#include "orchestrator/node/fleet.h"
#include "tests/support/namespace_watch.h"
#include "tests/support/root_only.h"
#include "tests/support/test_fleet.h"

namespace cuscus::node {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using posix::UniqueFd;

constexpr auto kLimit = 2s;

std::string text_of(const fs::path& path) {
  std::ifstream file{path};
  return {std::istreambuf_iterator<char>{file}, {}};
}

/// Names and inodes of everything of the host that a run could leave behind.
std::string host_state() {
  std::ostringstream state;
  state << text_of("/proc/self/mounts") << text_of("/proc/self/net/dev_mcast");
  struct if_nameindex* const table = ::if_nameindex();
  for (const auto* entry = table; entry != nullptr && entry->if_index != 0; ++entry) {
    state << entry->if_name << '\n';
  }
  ::if_freenameindex(table);
  std::error_code none;
  for (const auto& entry : fs::directory_iterator{"/run/netns", none}) {
    state << entry.path() << '\n';
  }
  return state.str();
}

/// A process and all that descend from it.
std::set<pid_t> family_of(pid_t ancestor) {
  std::multimap<pid_t, pid_t> children;
  for (const auto& entry : fs::directory_iterator{"/proc"}) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) {
      continue;
    }
    const std::string status = text_of(entry.path() / "status");
    if (const auto at = status.find("\nPPid:\t"); at != std::string::npos) {
      children.emplace(std::stoi(status.substr(at + 7)), std::stoi(name));
    }
  }
  std::set<pid_t> family;
  std::vector<pid_t> rest{ancestor};
  while (!rest.empty()) {
    const pid_t pid = rest.back();
    rest.pop_back();
    family.insert(pid);
    const auto [first, last] = children.equal_range(pid);
    for (auto child = first; child != last; ++child) {
      rest.push_back(child->second);
    }
  }
  return family;
}

/// Everything that is a fleet's, watched from outside: processes and network namespaces.
class Belongings {
 public:
  explicit Belongings(pid_t owner) {
    for (const pid_t pid : family_of(owner)) {
      processes_.push_back(posix::open_pidfd(pid));
      watch("/proc/" + std::to_string(pid) + "/ns/net");
    }
    for (const auto& entry : fs::directory_iterator{"/proc/" + std::to_string(owner) + "/fd"}) {
      std::error_code gone;
      if (fs::read_symlink(entry.path(), gone).string().starts_with("net:[")) {
        watch(entry.path());
      }
    }
  }

  [[nodiscard]] std::size_t processes() const { return processes_.size(); }
  [[nodiscard]] std::size_t namespaces() const { return seen_.size() - 1; }

  /// What is left of both after the limit.
  [[nodiscard]] std::size_t living_processes() const {
    std::size_t living = 0;
    const auto deadline = std::chrono::steady_clock::now() + kLimit;
    for (const UniqueFd& process : processes_) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          deadline - std::chrono::steady_clock::now());
      pollfd ended{.fd = process.get(), .events = POLLIN, .revents = 0};
      living += ::poll(&ended, 1, std::max(0, static_cast<int>(left.count()))) == 1 ? 0U : 1U;
    }
    return living;
  }
  [[nodiscard]] std::size_t living_namespaces() { return watch_.await_end(kLimit); }

 private:
  void watch(const fs::path& path) {
    const UniqueFd fd{posix::check("open a namespace", ::open(path.c_str(), O_RDONLY | O_CLOEXEC))};
    struct stat identity {};
    posix::check("fstat of a namespace", ::fstat(fd.get(), &identity));
    if (seen_.insert(identity.st_ino).second) {
      watch_.add(fd.get());
    }
  }

  static ino_t own_namespace() {
    struct stat identity {};
    posix::check("stat of the own namespace", ::stat("/proc/self/ns/net", &identity));
    return identity.st_ino;
  }

  test::NamespaceWatch watch_;
  std::set<ino_t> seen_{own_namespace()};
  std::vector<UniqueFd> processes_;
};

/// A process that owns a fleet, stopped after a step of its set-up.
class Owner {
 public:
  Owner(const std::string& attachment, int step) {
    std::array<int, 2> ends{};
    posix::check("pipe2", ::pipe2(ends.data(), O_CLOEXEC));
    reader_ = UniqueFd{ends[0]};
    const UniqueFd writer{ends[1]};
    const auto program = fs::read_symlink("/proc/self/exe").replace_filename("fleet_owner");
    process_.emplace(posix::ChildProcess::spawn(
        {.arguments = {program, attachment, "hold", std::to_string(step)},
         .environment = {"PATH=/usr/bin:/bin"},
         .output_fd = writer.get()}));
  }

  /// What it says first; "holds" when all is well.
  [[nodiscard]] std::string first_words() const {
    std::array<char, 256> text{};
    const ssize_t got = ::read(reader_.get(), text.data(), text.size());
    return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0))};
  }

  [[nodiscard]] posix::ChildProcess& process() { return *process_; }

 private:
  UniqueFd reader_;
  std::optional<posix::ChildProcess> process_;
};

TEST_CASE("a fleet's owner may be killed after any step and leaves nothing") {
  CUSCUS_ROOT_ONLY();
  const std::string attachment = GENERATE("bridge", "direct");
  // The fabric, three inits, three times links; then programs run.
  const int step = GENERATE(range(1, 9));
  const auto before = host_state();
  Owner owner{attachment, step};
  REQUIRE(owner.first_words() == "holds\n");
  Belongings belongings{owner.process().pid()};
  const auto inits = static_cast<std::size_t>(std::clamp(step - 1, 0, 3));
  // Owner and inits; with programs, each node has a shell and two sleepers too.
  CHECK(belongings.processes() >= 1 + inits + (step == 8 ? 3 * 2 : 0));
  CHECK(belongings.namespaces() == 1 + inits);

  owner.process().send_signal(SIGKILL);

  CHECK(belongings.living_processes() == 0);
  CHECK(belongings.living_namespaces() == 0);
  CHECK(host_state() == before);
}

TEST_CASE("a fleet that is let go leaves nothing either") {
  CUSCUS_ROOT_ONLY();
  const auto attachment = GENERATE(Attachment::kBridge, Attachment::kDirect);
  const auto before = host_state();
  std::optional<Fleet> fleet{std::in_place, test::test_fleet(3, attachment), FleetOptions{}};
  test::NamespaceWatch watch;
  watch.add(fleet->fabric().network_namespace().fd());
  for (const Node& node : fleet->nodes()) {
    watch.add(node.network_namespace().fd());
  }

  REQUIRE(watch.await_end(0ms) == 1 + fleet->nodes().size());

  fleet.reset();

  CHECK(watch.await_end(kLimit) == 0);
  CHECK(host_state() == before);
}

TEST_CASE("a node whose init is killed is dead at once, and its TAP stays usable") {
  CUSCUS_ROOT_ONLY();
  Fleet fleet{test::test_fleet(1, GENERATE(Attachment::kBridge, Attachment::kDirect)), {}};
  Node& node = fleet.nodes()[0];

  node.kill();

  pollfd ended{.fd = node.init_pidfd(), .events = POLLIN, .revents = 0};
  CHECK(::poll(&ended, 1, 10'000) == 1);
  CHECK_THROWS_AS(node.try_receive(), ipc::PeerError);
  std::array<char, 64> frame{};
  CHECK(::read(node.tap_fd(), frame.data(), frame.size()) == -1);
  CHECK(errno == EAGAIN);
}

}  // namespace
}  // namespace cuscus::node
