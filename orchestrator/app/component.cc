#include "orchestrator/app/component.h"

#include <algorithm>
#include <utility>

namespace cuscus::orchestrator {
namespace {

/// Every sample has the state in metrics.csv.
constexpr std::size_t kMostStateBytes = 32;

}  // namespace

Component::Component(boost::asio::io_context& loop, std::string name, ipc::ControlSocket socket,
                     std::function<void()> on_change)
    : name_{std::move(name)},
      on_change_{std::move(on_change)},
      last_heard_{std::chrono::steady_clock::now()},
      channel_{loop,
               std::move(socket),
               {.on_message = [this](const proto::Envelope& envelope) { handle(envelope); },
                .on_closed =
                    [this](const std::string&) {
                      gone_ = true;
                      on_change_();
                    }}} {}

void Component::configure(const std::vector<GivenDescriptor>& descriptors,
                          const proto::Configure& configure) {
  for (std::size_t begin = 0; begin < descriptors.size();
       begin += ipc::ControlSocket::kMaxDescriptors) {
    const std::size_t end =
        std::min(descriptors.size(), begin + ipc::ControlSocket::kMaxDescriptors);
    proto::Envelope envelope;
    std::vector<int> fds;
    for (std::size_t i = begin; i < end; ++i) {
      auto* const item = envelope.mutable_descriptors()->add_items();
      item->set_kind(descriptors[i].kind);
      item->set_node(descriptors[i].node);
      fds.push_back(descriptors[i].fd);
    }
    channel_.send(envelope, fds);
  }
  proto::Envelope envelope;
  *envelope.mutable_configure() = configure;
  channel_.send(envelope);
}

void Component::start(std::int64_t start_monotonic_ns) {
  proto::Envelope envelope;
  envelope.mutable_start()->set_start_monotonic_ns(start_monotonic_ns);
  channel_.send(envelope);
}

void Component::stop(const std::string& reason) {
  proto::Envelope envelope;
  envelope.mutable_stop()->set_reason(reason);
  channel_.send(envelope);
}

void Component::handle(const proto::Envelope& envelope) {
  last_heard_ = std::chrono::steady_clock::now();
  switch (envelope.body_case()) {
    case proto::Envelope::kReady:
      ready_ = true;
      break;
    case proto::Envelope::kStatus:
      state_ = envelope.status().state().substr(0, kMostStateBytes);
      if (envelope.status().has_so_far()) {
        so_far_ = envelope.status().so_far();
      }
      return;
    case proto::Envelope::kReport:
      report_ = envelope.report();
      break;
    case proto::Envelope::kFailure:
      failure_ = envelope.failure().text();
      break;
    default:
      return;
  }
  on_change_();
}

}  // namespace cuscus::orchestrator
