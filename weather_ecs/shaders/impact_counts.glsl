// Counters of the impacts that the compute backend keeps; gpu/impact_list.py lays them out.
layout(std430, binding = 2) buffer ImpactCounts {
    uint impact_total;    // written, ever
    uint impact_dropped;  // not written, ever: the frame's room was used up
    uint total_before;    // the same two, when this frame began
    uint dropped_before;
    uvec3 find_groups;    // work groups that impact_find.comp needs for one container
    uint sunk_count;      // drops of one container that have come below the surface in this step
};

const uint FIND_GROUP = 64u;  // drops in a work group of impact_find.comp
