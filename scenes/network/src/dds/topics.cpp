// SPDX-License-Identifier: BSD-3-Clause
#include "dds/topics.h"

#include <dds/ddsrt/log.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <utility>

#include "messages/dense_state.h"
#include "vps/errors.h"
#include "vps_device/periodic_thread.h"

namespace vps::scenes {

namespace {

/// struct Message { sequence<octet> bytes; }, in the memory layout of Cyclone DDS.
struct Message {
  dds_sequence_t bytes;
};
constexpr std::uint32_t code(unsigned a, unsigned b, unsigned c) {
  return a | b | c;
}
constexpr std::uint32_t kOperations[] = {code(DDS_OP_ADR, DDS_OP_TYPE_SEQ, DDS_OP_SUBTYPE_1BY),
                                         offsetof(Message, bytes), DDS_OP_RTS};
/// struct State { octet bytes[40]; }: four bytes shorter than a sequence, which stores its length.
struct State {
  std::array<char, kDenseBytes> bytes;
};
constexpr std::uint32_t kStateOperations[] = {code(DDS_OP_ADR, DDS_OP_TYPE_ARR, DDS_OP_SUBTYPE_1BY),
                                              offsetof(State, bytes), kDenseBytes, DDS_OP_RTS};
template <typename Type>
constexpr dds_topic_descriptor_t descriptor(const char* name, const std::uint32_t* operations) {
  return {.m_size = sizeof(Type),
          .m_align = alignof(Type),
          .m_flagset = 0,
          .m_nkeys = 0,
          .m_typename = name,
          .m_keys = nullptr,
          .m_nops = 2,
          .m_ops = operations,
          .m_meta = "",
          .type_information = {},
          .type_mapping = {},
          .restrict_data_representation = 0};
}
constexpr dds_topic_descriptor_t kMessageType = descriptor<Message>("vps_node::Message", kOperations),
                                 kStateType = descriptor<State>("vps_node::State", kStateOperations);

void require(dds_return_t result, const char* what) {
  if (result >= 0) return;
  throw LoadError("", "",
                  std::string("the network: ").append(what).append(": ").append(dds_strretcode(-result)));
}

bool isLoopback(const std::string& interface) {
  return interface == "lo";
}

/// Raises the priority of a receiving thread of DDS, if the system allows it.
void raiseThisThread() {
  constexpr int kPriority = 76;  // below the haptic loop's 80, above the threads that use the received data
  thread_local bool has_asked = false;
  if (!has_asked) device::requestRealTime(kPriority, false);
  has_asked = true;
}

void requireName(const std::string& interface) {
  for (const char c : interface)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != ':' && c != '-' && c != '_')
      throw LoadError("", "",
                      "--network " + interface + " is no network interface; `ip link` lists the interfaces");
}

/// Returns the DDS domain for a network; a process can create each domain only once.
dds_domainid_t domainOf(const SessionNetwork& network, int wanted) {
  struct Made {
    dds_domainid_t domain;
    std::string security;
  };
  static std::mutex mutex;
  static std::map<std::pair<std::string, int>, Made> domains;
  const std::lock_guard lock(mutex);
  const std::string& interface = network.interface;
  const auto found = domains.find({interface, wanted});
  if (found != domains.end()) {
    if (found->second.security == network.security) return found->second.domain;
    throw LoadError("", "", "--network " + interface + " was used with other certificates by this process");
  }
  requireName(interface);
  // Cyclone DDS logs a line for each peer without a certificate of our authority; its log is disabled, so
  // that it does not mix with the program's messages.
  dds_set_log_sink([](void*, const dds_log_data_t*) {}, nullptr);
  // Loopback has no multicast, so participants look for each other at the ports of the first few
  // participants.
  const std::string find =
      isLoopback(interface)
          ? "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto"
            "</ParticipantIndex><MaxAutoParticipantIndex>48</MaxAutoParticipantIndex><Peers><Peer "
            "Address=\"127.0.0.1\"/></Peers></Discovery>"
          : "</General>";
  const std::string settings =
      "<CycloneDDS><Domain id=\"any\"><General><Interfaces><NetworkInterface name=\"" + interface +
      "\"/></Interfaces>" + find + securitySettings(network, isLoopback(interface)) +
      "<Tracing><Verbosity>none</Verbosity></Tracing></Domain></CycloneDDS>";
  // Different interfaces use different domains, which separates their sessions on one machine.
  const dds_domainid_t domain = wanted >= 0             ? static_cast<dds_domainid_t>(wanted)
                                : isLoopback(interface) ? 77
                                                        : 78;
  require(dds_create_domain(domain, settings.c_str()), ("interface " + interface).c_str());
  domains[{interface, wanted}] = {domain, network.security};
  return domain;
}

struct Qos {
  explicit Qos(Delivery delivery) {
    if (delivery == Delivery::Newest) {
      dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
      dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 16);  // samples are kept until a thread of DDS takes them
    } else {
      dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
      dds_qset_history(qos, delivery == Delivery::Kept ? DDS_HISTORY_KEEP_LAST : DDS_HISTORY_KEEP_ALL, 1);
    }
    dds_qset_durability(
        qos, delivery == Delivery::Kept ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  }
  ~Qos() { dds_delete_qos(qos); }
  Qos(const Qos&) = delete;
  Qos& operator=(const Qos&) = delete;
  dds_qos_t* qos = dds_create_qos();
};

}  // namespace

DdsParticipant::DdsParticipant(const SessionNetwork& network, int domain)
    : entity_(dds_create_participant(domainOf(network, domain), nullptr, nullptr)) {
  require(entity_, network.security.empty()
                       ? ("interface " + network.interface).c_str()
                       : ("the certificates in " + network.security + " do not belong together").c_str());
  // Threads of DDS use the security plugins until they end, so DDS is shut down before the plugins are
  // unloaded at exit.
  static const bool ends_in_order = std::atexit([] { dds_delete(DDS_CYCLONEDDS_HANDLE); }) == 0;
  (void)ends_in_order;
}

DdsParticipant::~DdsParticipant() {
  dds_delete(entity_);
}

std::string topicName(const std::string& session, const std::string& name) {
  std::string all = "vps/" + session + "/";
  std::replace(all.begin(), all.end(), '-', '/');  // topic names must not contain -
  return all + name;
}

struct DdsTopic::Work {
  static void onData(dds_entity_t reader, void* self) { static_cast<Work*>(self)->take(reader); }
  void take(dds_entity_t reader) {
    raiseThisThread();
    const std::lock_guard lock(mutex);
    for (;;) {
      void* sample = nullptr;
      dds_sample_info_t info{};
      const dds_return_t count = dds_take(reader, &sample, &info, 1, 1);
      if (count <= 0) return;
      if (info.valid_data && type == TopicType::State)
        receiveState(*static_cast<const State*>(sample), info.source_timestamp);
      else if (info.valid_data) {
        const auto* message = static_cast<const Message*>(sample);
        receive({reinterpret_cast<const char*>(message->bytes._buffer), message->bytes._length});
      }
      dds_return_loan(reader, &sample, count);
    }
  }
  void receiveState(const State& state, dds_time_t sent_ns) {
    std::array<char, kDenseMessageBytes> bytes;
    std::memcpy(bytes.data(), state.bytes.data(), kDenseBytes);
    for (std::size_t i = 0; i < sizeof sent_ns; ++i)
      bytes[kDenseBytes + i] = static_cast<char>(static_cast<std::uint64_t>(sent_ns) >> 8 * i);
    receive({bytes.data(), bytes.size()});
  }

  std::mutex mutex;
  std::function<void(std::string_view)> receive;
  TopicType type = TopicType::Message;
  dds_entity_t topic = 0, end = 0;
};

DdsTopic::DdsTopic(const DdsParticipant& participant, const std::string& name, Delivery delivery,
                   std::function<void(std::string_view)> receive, TopicType type)
    : work_(std::make_unique<Work>()) {
  const Qos qos(delivery);
  work_->type = type;
  const dds_topic_descriptor_t& described = type == TopicType::State ? kStateType : kMessageType;
  work_->topic = dds_create_topic(participant.entity(), &described, name.c_str(), nullptr, nullptr);
  require(work_->topic, "topic");
  work_->receive = std::move(receive);
  if (!work_->receive) {
    work_->end = dds_create_writer(participant.entity(), work_->topic, qos.qos, nullptr);
    require(work_->end, "writer");
    return;
  }
  dds_listener_t* listener = dds_create_listener(work_.get());
  dds_lset_data_available(listener, &Work::onData);
  work_->end = dds_create_reader(participant.entity(), work_->topic, qos.qos, listener);
  dds_delete_listener(listener);
  require(work_->end, "reader");
}

DdsTopic::~DdsTopic() {
  dds_delete(work_->end);  // waits for a running call of the listener
  dds_delete(work_->topic);
}

void DdsTopic::write(std::string_view bytes) {
  if (work_->type == TopicType::State) {
    if (bytes.size() != kDenseMessageBytes) return;
    State state{};
    std::memcpy(state.bytes.data(), bytes.data(), kDenseBytes);
    std::uint64_t sent_ns = 0;
    for (std::size_t i = 0; i < sizeof sent_ns; ++i)
      sent_ns |= std::uint64_t{static_cast<unsigned char>(bytes[kDenseBytes + i])} << 8 * i;
    dds_write_ts(work_->end, &state, static_cast<dds_time_t>(sent_ns));
    return;
  }
  Message message{};
  message.bytes._maximum = message.bytes._length = static_cast<std::uint32_t>(bytes.size());
  message.bytes._buffer = reinterpret_cast<std::uint8_t*>(const_cast<char*>(bytes.data()));
  dds_write(work_->end, &message);
}

}  // namespace vps::scenes
