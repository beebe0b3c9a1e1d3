// SPDX-License-Identifier: BSD-3-Clause
#include "subject.h"

namespace vps::bench {

struct Subject::State {
  const VoxMap& map;
  const PointShell& shell;
  SubjectOptions options;
  ContactSet contacts;
};

std::vector<std::string> instructionPaths() {
  return {"best"};
}

Subject::Subject(const VoxMap& map, const PointShell& shell, const SubjectOptions& options)
    : state_(new State{map, shell, options, ContactSet(shell.size())}) {}
Subject::~Subject() = default;

Answer Subject::step(const Pose& X_MP) {
  QueryOptions query;
  query.is_exhaustive = state_->options.is_exhaustive;
  query.gradient = Gradient::Trilinear;
  const QueryResult result = queryContacts(state_->map, state_->shell, X_MP, query, state_->contacts);
  const std::vector<Contact>& contacts = state_->contacts.contacts;
  Answer answer{0, result.min_distance_m, penaltyWrench(contacts, kStiffness_N_per_m3, Vec3::Zero())};
  for (const Contact& c : contacts) answer.touching += c.distance_m < 0;
  return answer;
}

struct Mounting::State {
  Mesh mounted;
  VoxMap base;
};

Mounting::Mounting(const Mesh& base, const Mesh& mounted, const VoxMapSettings& settings)
    : state_(new State{mounted, cookVoxMap({{&base, Pose()}}, settings)}) {}
Mounting::~Mounting() = default;

VoxMap Mounting::mount(const Pose& X_BM) const {
  return mountVoxMap(state_->base, {&state_->mounted, X_BM});
}

}  // namespace vps::bench
