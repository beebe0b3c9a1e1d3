// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/pair/pair_algorithm.h"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btCompoundCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btConvexConcaveCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <LinearMath/btAabbUtil2.h>

#include <algorithm>
#include <vector>

#include "narrowphase/pair/pair_state.h"
#include "narrowphase/pair/pair_view.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/shape.h"

namespace vps::bullet {

static_assert(sizeof(CompoundPair) <= sizeof(btConvexConcaveCollisionAlgorithm));

namespace {

struct AlgorithmDeleter {
  btDispatcher* dispatcher;
  void operator()(btCollisionAlgorithm* algorithm) const {
    algorithm->~btCollisionAlgorithm();
    dispatcher->freeCollisionAlgorithm(algorithm);
  }
};
using OwnedAlgorithm = std::unique_ptr<btCollisionAlgorithm, AlgorithmDeleter>;

const btCompoundShape& compoundOf(const btCollisionObjectWrapper& body) {
  return *static_cast<const btCompoundShape*>(body.getCollisionShape());
}

struct Aabb {
  btVector3 min, max;
  Aabb(const btCollisionShape& shape, const btTransform& X_WS) { shape.getAabb(X_WS, min, max); }
  void extend(double by_m) {
    const btVector3 by(toBt(by_m), toBt(by_m), toBt(by_m));
    min -= by;
    max += by;
  }
};

/// Greatest displacement of a point of the box relative to the other body within the step.
double travel_m(const Aabb& box, const Twist& V, double dt_s) {
  const Vec3 center = 0.5 * fromBt(box.min + box.max);
  const double radius_m = 0.5 * fromBt(box.max - box.min).norm();
  return dt_s * ((V.v + V.w.cross(center)).norm() + V.w.norm() * radius_m);
}

/// The children whose boxes overlap a box, in ascending order.
std::vector<int> childrenWithin(const btCompoundShape& compound, const btTransform& X_WS, const Aabb& box) {
  std::vector<int> within;
  if (const btDbvt* tree = compound.getDynamicAabbTree()) {
    struct Collect : btDbvt::ICollide {
      std::vector<int>& found;
      explicit Collect(std::vector<int>& into) : found(into) {}
      void Process(const btDbvtNode* leaf) override { found.push_back(leaf->dataAsInt); }
    } collect(within);
    btVector3 min, max;
    btTransformAabb(box.min, box.max, 0, X_WS.inverse(), min, max);
    tree->collideTV(tree->m_root, btDbvtVolume::FromMM(min, max), collect);
    std::sort(within.begin(), within.end());
  } else {
    for (int i = 0; i < compound.getNumChildShapes(); ++i) within.push_back(i);
  }
  std::erase_if(within, [&](int i) {
    const Aabb child(*compound.getChildShape(i), X_WS * compound.getChildTransform(i));
    return !TestAabbAgainstAabb2(child.min, child.max, box.min, box.max);
  });
  return within;
}

/// Sets a child of one body in Bullet's result, as long as this object exists.
class ResultOfChild {
 public:
  ResultOfChild(btManifoldResult& result, const btCollisionObjectWrapper& child) : result_(result) {
    is_first_ = result.getBody0Internal() == child.getCollisionObject();
    before_ = is_first_ ? result.getBody0Wrap() : result.getBody1Wrap();
    set(&child);
    if (is_first_)
      result.setShapeIdentifiersA(-1, child.m_index);
    else
      result.setShapeIdentifiersB(-1, child.m_index);
  }
  ~ResultOfChild() { set(before_); }
  ResultOfChild(const ResultOfChild&) = delete;
  ResultOfChild& operator=(const ResultOfChild&) = delete;

 private:
  void set(const btCollisionObjectWrapper* body) {
    if (is_first_)
      result_.setBody0Wrap(body);
    else
      result_.setBody1Wrap(body);
  }
  btManifoldResult& result_;
  const btCollisionObjectWrapper* before_;
  bool is_first_;
};

}  // namespace

bool containsShape(const btCollisionShape& shape) {
  if (!shape.isCompound()) return dynamic_cast<const Shape*>(&shape) != nullptr;
  const auto* compound =
      dynamic_cast<const btCompoundShape*>(&shape);  // GImpact compounds are not btCompoundShape
  for (int i = 0; compound && i < compound->getNumChildShapes(); ++i)
    if (containsShape(*compound->getChildShape(i))) return true;
  return false;
}

struct CompoundPair::State {
  std::shared_ptr<Context> context;
  int side = 0;  ///< the body whose children are visited
  int revision = 0;
  std::vector<OwnedAlgorithm> children;  // null for children that are not near
};

CompoundPair::CompoundPair(const btCollisionAlgorithmConstructionInfo& info,
                           const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                           std::shared_ptr<Context> context)
    : PairAlgorithm(info, body0, body1), state_(std::make_unique<State>()) {
  state_->context = std::move(context);
  state_->side = body0->getCollisionShape()->isCompound() ? 0 : 1;
}

CompoundPair::~CompoundPair() = default;

void CompoundPair::processCollision(const btCollisionObjectWrapper* body0,
                                    const btCollisionObjectWrapper* body1, const btDispatcherInfo& info,
                                    btManifoldResult* result) {
  State& state = *state_;
  const btCollisionObjectWrapper* bodies[] = {body0, body1};
  const btCollisionObjectWrapper &mine = *bodies[state.side], &other = *bodies[1 - state.side];
  const btCompoundShape& compound = compoundOf(mine);
  if (state.revision != compound.getUpdateRevision()) state.children.clear();  // children have changed
  state.revision = compound.getUpdateRevision();
  while (state.children.size() < static_cast<std::size_t>(compound.getNumChildShapes()))
    state.children.emplace_back(nullptr, AlgorithmDeleter{m_dispatcher});

  const double asked_m = result->m_closestPointDistanceThreshold;  // 0 in a step
  const Twist V0 = predictedVelocity(*body0->getCollisionObject(), info.m_timeStep);
  const Twist V1 = predictedVelocity(*body1->getCollisionObject(), info.m_timeStep);
  const Twist V{V0.w - V1.w, V0.v - V1.v};
  Aabb reach(*other.getCollisionShape(), other.getWorldTransform());
  // The bodies meet within both boxes, so the lesser of both speed bounds holds.
  reach.extend(asked_m + state.context->settings.contact_margin_m +
               std::min(travel_m(Aabb(compound, mine.getWorldTransform()), V, info.m_timeStep),
                        travel_m(reach, V, info.m_timeStep)));
  const std::vector<int> near = childrenWithin(compound, mine.getWorldTransform(), reach);
  for (int i = 0; i < compound.getNumChildShapes(); ++i)
    if (!std::binary_search(near.begin(), near.end(), i)) state.children[i].reset();

  for (const int i : near) {
    const btCollisionShape* shape = compound.getChildShape(i);
    if (gCompoundChildShapePairCallback &&
        !gCompoundChildShapePairCallback(other.getCollisionShape(), shape)) {
      state.children[i].reset();
      continue;
    }
    const btTransform X_WC = mine.getWorldTransform() * compound.getChildTransform(i);
    const btCollisionObjectWrapper child(&mine, shape, mine.getCollisionObject(), X_WC, -1, i);
    bodies[state.side] = &child;
    const bool is_query = asked_m > 0;
    OwnedAlgorithm of_query(nullptr, AlgorithmDeleter{m_dispatcher});
    OwnedAlgorithm& algorithm = is_query ? of_query : state.children[i];
    if (!algorithm)
      algorithm.reset(
          m_dispatcher->findAlgorithm(bodies[0], bodies[1], nullptr,
                                      is_query ? BT_CLOSEST_POINT_ALGORITHMS : BT_CONTACT_POINT_ALGORITHMS));
    const ResultOfChild of_child(*result, child);
    if (algorithm) algorithm->processCollision(bodies[0], bodies[1], info, result);
  }
}

void CompoundPair::getAllContactManifolds(btManifoldArray& manifolds) {
  for (const OwnedAlgorithm& child : state_->children)
    if (child) child->getAllContactManifolds(manifolds);
}

}  // namespace vps::bullet
