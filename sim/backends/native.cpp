// The integer model of golden/datapath/machine.py, compiled. sim/backends/native_source.py writes edge.inc and node.inc
// from the graphs of the datapath; their names are those of the equations.
#include <cstdint>
#include <utility>
#include <vector>

using Int = int64_t;
#include "constants.inc"

struct Node {
    Int x[3], v[3], x_base[3], v_base[3], x_total[3], v_total[3];
    Int pull[3], load[3], force[3], inverse_mass[INVERSE_MASS_FIELDS];
};

struct Edge {
    Int i, j, length, base, ratio, total;
    const Int *material;
};

// Shared by all nodes and edges
struct Common {
    Int velocity_shift;
    const Int *inverse, *damper;
    Int *faults;
};

static inline Int round_half_up(Int raw, Int drop) { return (raw + (Int(1) << drop >> 1)) >> drop; }

static inline Int saturate(Int rounded, Int floor, Int low, Int high, Int *fault) {
    const Int result = rounded < low ? low : rounded > high ? high : rounded;
    if (__builtin_expect(result != rounded, 0) && fault) *fault += floor > high || rounded < low;
    return result;
}

template <bool cut>
static inline Int shift_right(Int raw, Int drop, Int right, Int low, Int high, Int *fault) {
    if (__builtin_expect(right < 0 && raw != 0, 0)) {
        if (fault) ++*fault;
        return raw < 0 ? low : high;
    }
    const Int sum = drop + right, by = sum < 0 ? 0 : sum > 62 ? 62 : sum;
    return saturate(cut ? raw >> by : round_half_up(raw, by), raw >> by, low, high, fault);
}

// Clears the bits that repeat the sign
static inline Int magnitude(Int raw) { return raw ^ raw >> 63; }

// The left shift, at most `most`, that integers of `bits` bits and a sign allow, given the OR of their magnitudes
static inline Int lead(Int magnitudes, Int bits, Int most) {
    const Int left = bits - (magnitudes ? 64 - __builtin_clzll(magnitudes) : 0);
    return left < most ? left : most;
}

template <int stage>
static inline void edge_stage(const Common &common, const Node &i, const Node &j, Edge &edge, Int *pull) {
#include "edge.inc"
}

template <int stage>
static inline void node_stage(const Common &common, Node &node) {
#include "node.inc"
}

template <int stage>
static void run_stage(const Common &common, std::vector<Node> &nodes, std::vector<Edge> &edges) {
    for (Node &node : nodes)
        for (Int &component : node.pull) component = 0;
    for (Edge &edge : edges) {
        Int pull[3];
        Node &i = nodes[edge.i], &j = nodes[edge.j];
        edge_stage<stage>(common, i, j, edge, pull);
        for (int axis = 0; axis < 3; ++axis) {
            i.pull[axis] += pull[axis];
            j.pull[axis] -= pull[axis];
        }
    }
    for (Node &node : nodes) node_stage<stage>(common, node);
}

template <int... stage>
static void run_step(const Common &common, std::vector<Node> &nodes, std::vector<Edge> &edges,
                     std::integer_sequence<int, stage...>) {
    (run_stage<stage>(common, nodes, edges), ...);
}

// x, v, load, force: (nodes, 3); ends: (edges, 2); tables and records: word after word, each field an integer
extern "C" void run(Int steps, Int node_count, Int edge_count, Int velocity_shift, Int *x, Int *v, Int *ratio,
                    Int *force, const Int *load, const Int *inverse_mass, const Int *ends, const Int *edge_material,
                    const Int *length, const Int *materials, const Int *inverse, const Int *damper, Int *faults) {
    const Common common = {velocity_shift, inverse, damper, faults};
    std::vector<Node> nodes(node_count);
    std::vector<Edge> edges(edge_count);
    for (Int n = 0; n < node_count; ++n) {
        Node &node = nodes[n] = {};
        for (int axis = 0; axis < 3; ++axis) {
            node.x[axis] = node.x_base[axis] = x[3 * n + axis];
            node.v[axis] = node.v_base[axis] = v[3 * n + axis];
            node.load[axis] = load[3 * n + axis];
            node.force[axis] = force[3 * n + axis];
        }
        for (int field = 0; field < INVERSE_MASS_FIELDS; ++field)
            node.inverse_mass[field] = inverse_mass[INVERSE_MASS_FIELDS * n + field];
    }
    for (Int e = 0; e < edge_count; ++e) {
        const Int *material = materials + MATERIAL_FIELDS * edge_material[e];
        edges[e] = {ends[2 * e], ends[2 * e + 1], length[e], ratio[e], ratio[e], 0, material};
    }

    const auto stages = std::make_integer_sequence<int, STAGES>();
    for (Int step = 0; step < steps; ++step) run_step(common, nodes, edges, stages);

    for (Int n = 0; n < node_count; ++n)
        for (int axis = 0; axis < 3; ++axis) {
            x[3 * n + axis] = nodes[n].x[axis];
            v[3 * n + axis] = nodes[n].v[axis];
            force[3 * n + axis] = nodes[n].force[axis];
        }
    for (Int e = 0; e < edge_count; ++e) ratio[e] = edges[e].ratio;
}
