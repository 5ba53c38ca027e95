// SPDX-License-Identifier: Apache-2.0
// The yardstick of a profile: as fast as this kernel streams through memory, no stage can move its queues faster (McCalpin
// 1995, "Memory bandwidth and machine balance", the kernel COPY). With no items it tells what a launch costs.
kernel void copy(global const uint4* from, global uint4* to, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i < count) to[i] = from[i];
}
