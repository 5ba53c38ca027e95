# SPDX-License-Identifier: Apache-2.0
"""The reflection model of tools/check_radiometry.py: mean albedos by an integral over microfacet normals (the
program integrates over directions), materials, texture means by samples (the program has exact integrals)."""
import math

import numpy as np

from radiometry_reader import float32

MIRROR_ROUGHNESS = np.float32(0.0316228)
TABLE_SIZE = 32
SAMPLES = 4e6  # of the texture on one mesh, at least


def albedo_nodes(row):
    """A and B at the table's 32 cosines for sqrt(alpha) = row / 31: integrals over microfacet normals h.

    a(mu) = int F(o.h) G2(o, i) (o.h) / (mu cos theta_h) D cos theta_h dh with
    tan^2 theta_h = alpha^2 u / (1 - u), so that D cos theta_h dh = du dphi / (2 pi). Reflected directions stay
    above the surface while cos phi > limit(theta_h); both integrals end, and the outer one is split, where that
    condition changes.
    """
    mu = np.arange(TABLE_SIZE) / (TABLE_SIZE - 1)
    if row == 0:
        return 1 - (1 - mu) ** 5, (1 - mu) ** 5
    mu = np.maximum(mu, 1e-9)[:, None, None]  # the limit mu -> 0 exists
    alpha = (row / (TABLE_SIZE - 1)) ** 2
    theta_o = np.arccos(mu)
    x, w = np.polynomial.legendre.leggauss(96)
    x, w = (x + 1) / 2, w / 2
    share = lambda theta: np.tan(theta) ** 2 / (alpha**2 + np.tan(theta) ** 2)
    split = share((np.pi / 2 - theta_o) / 2)
    end = share(np.minimum((np.pi / 2 + theta_o) / 2, np.pi / 2))
    a = b = 0.0
    for low, high in ((0 * split, split), (split, end)):
        # sin^2 takes away the square roots at both ends.
        s = x[None, :, None]
        u = low + (high - low) * np.sin(np.pi / 2 * s) ** 2
        du = w[None, :, None] * (high - low) * np.pi / 2 * np.sin(np.pi * s)
        theta_h = np.arctan(alpha * np.sqrt(u / (1 - u)))
        with np.errstate(divide="ignore", invalid="ignore"):
            limit = (mu / (2 * np.cos(theta_h)) - mu * np.cos(theta_h)) / (np.sin(theta_o) * np.sin(theta_h))
        limit = np.where(np.sin(theta_o) * np.sin(theta_h) == 0, -1, limit)
        phi_end = np.arccos(np.clip(limit, -1, 1))
        t = x[None, None, :]
        phi = phi_end * np.sin(np.pi / 2 * t)
        dphi = phi_end * w[None, None, :] * np.pi / 2 * np.cos(np.pi / 2 * t)
        o_dot_h = np.sin(theta_o) * np.sin(theta_h) * np.cos(phi) + mu * np.cos(theta_h)
        mu_i = np.maximum(2 * o_dot_h * np.cos(theta_h) - mu, 0)
        root = lambda c: np.sqrt(c * c + alpha**2 * (1 - c * c))
        g2 = 2 * mu * mu_i / (mu * root(mu_i) + mu_i * root(mu))
        weight = du * dphi / np.pi * g2 * o_dot_h / (mu * np.cos(theta_h))
        grazing = np.clip(1 - o_dot_h, 0, 1) ** 5
        a = a + (weight * (1 - grazing)).sum(axis=(1, 2))
        b = b + (weight * grazing).sum(axis=(1, 2))
    return a, b


class Albedo:
    rows = {}

    @classmethod
    def mean(cls, alpha):
        """Cosine-weighted means of A and B, as the program's bilinear table has them."""
        if alpha == 0:
            return 20 / 21, 1 / 21
        position = math.sqrt(alpha) * (TABLE_SIZE - 1)
        row = min(int(position), TABLE_SIZE - 2)
        for r in (row, row + 1):
            if r not in cls.rows:
                cls.rows[r] = albedo_nodes(r)
        mu = np.arange(TABLE_SIZE) / (TABLE_SIZE - 1)
        means = []
        for k in (0, 1):
            f = (1 - (position - row)) * cls.rows[row][k] + (position - row) * cls.rows[row + 1][k]
            # Simpson's rule is exact for 2 mu times a linear function.
            middle = 2 * (mu[:-1] + mu[1:]) / 2 * (f[:-1] + f[1:]) / 2
            means.append(((2 * mu * f)[:-1] + 4 * middle + (2 * mu * f)[1:]).sum() / 6 / (TABLE_SIZE - 1))
        return means


def mean_pane_reflectance():
    mu, w = np.polynomial.legendre.leggauss(64)
    mu = (mu + 1) / 2
    f = 0.04 + 0.96 * (1 - mu) ** 5
    return float((w * mu * 2 * f / (1 + f)).sum())


class Material:
    def __init__(self, gltf, m):
        extensions = m.get("extensions", {})
        pbr = m.get("pbrMetallicRoughness", {})
        specular = extensions.get("KHR_materials_specular", {})
        self.base = float32(pbr.get("baseColorFactor", [1, 1, 1, 1])[:3])
        self.texture = pbr.get("baseColorTexture")
        metallic, roughness = pbr.get("metallicFactor", 1), pbr.get("roughnessFactor", 1)
        if "metallicRoughnessTexture" in pbr:
            mean = gltf.image(pbr["metallicRoughnessTexture"]["index"]).reshape(-1, 3).mean(axis=0) / 255
            metallic, roughness = metallic * mean[2], roughness * mean[1]
        metallic = float(float32(metallic))
        roughness32 = np.float32(roughness)
        self.alpha = 0.0 if roughness32 < MIRROR_ROUGHNESS else float(roughness32) ** 2
        factor = float(float32(specular.get("specularFactor", 1)))
        color = float32(specular.get("specularColorFactor", [1, 1, 1]))
        transmission = extensions.get("KHR_materials_transmission", {}).get("transmissionFactor", 0)
        transmission = float(float32(transmission))
        self.sides = 2 if m.get("doubleSided") else 1
        self.unlit = "KHR_materials_unlit" in extensions
        strength = extensions.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
        emission = np.array(m.get("emissiveFactor", [0, 0, 0]), float) * strength
        if "emissiveTexture" in m:
            emission = emission * srgb(gltf.image(m["emissiveTexture"]["index"])).reshape(-1, 3).mean(axis=0)
        self.emission = np.zeros(3) if self.unlit else float32(emission)
        self.opacity = 1 - transmission * (1 - mean_pane_reflectance())
        self.rough = self.alpha > 0 and (factor > 0 or metallic > 0) and metallic < 1 and not self.unlit
        mean_a, mean_b = Albedo.mean(self.alpha) if factor > 0 or metallic > 0 else (0, 0)
        f0 = (1 - metallic) * np.minimum(0.04 * color, 1) * factor + metallic * self.base
        f90 = factor + (1 - factor) * metallic
        scale = (1 - metallic) * (1 - transmission) * (1 - (f0 * mean_a + f90 * mean_b))
        self.scale = np.zeros(3) if self.unlit else scale  # times the base colour: R


def srgb(codes):
    c = np.asarray(codes, float) / 255
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


class Texture:
    def __init__(self, gltf, index):
        sampler_index = gltf.json["textures"][index].get("sampler")
        sampler = gltf.json["samplers"][sampler_index] if sampler_index is not None else {}
        self.texels = srgb(gltf.image(index))
        self.nearest = sampler.get("magFilter") == 9728
        self.wraps = sampler.get("wrapS", 10497), sampler.get("wrapT", 10497)

    def wrap(self, k, axis):
        """Texel columns (axis 0) or rows (axis 1) for any integers."""
        size, mode = self.texels.shape[1 - axis], self.wraps[axis]
        if mode == 33071:
            return np.clip(k, 0, size - 1)
        if mode == 33648:
            k = np.mod(k, 2 * size)
            return np.where(k < size, k, 2 * size - 1 - k)
        return np.mod(k, size)

    def sample(self, uv):
        height, width, _ = self.texels.shape
        p = uv * [width, height]
        if self.nearest:
            i, j = np.floor(p).astype(np.int64).T
            return self.texels[self.wrap(j, 1), self.wrap(i, 0)]
        p = p - 0.5
        cell = np.floor(p).astype(np.int64)
        u, v = (p - cell).T[:, :, None]
        left, right = self.wrap(cell[:, 0], 0), self.wrap(cell[:, 0] + 1, 0)
        upper, lower = self.wrap(cell[:, 1], 1), self.wrap(cell[:, 1] + 1, 1)
        return ((1 - v) * ((1 - u) * self.texels[upper, left] + u * self.texels[upper, right]) +
                v * ((1 - u) * self.texels[lower, left] + u * self.texels[lower, right]))

    def means(self, corners, rng):
        """Mean colours over n x 3 x 2 corners in uv by stratified samples: two per texel's side or more."""
        height, width, _ = self.texels.shape
        edges = (corners - np.roll(corners, 1, axis=1)) * [width, height]
        longest = np.linalg.norm(edges, axis=2).max(axis=1)
        result = np.zeros((len(corners), 3))
        least = 2.0 ** np.clip(np.floor(np.log2(SAMPLES / max(1, len(corners))) / 2), 2, 10)
        sides = np.clip(2.0 ** np.ceil(np.log2(2 * longest + 1)), least, max(least, 512)).astype(int)
        for n in np.unique(sides):
            i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
            for t in np.nonzero(sides == n)[0]:
                a = (i.ravel() + rng.random(n * n)) / n
                b = (j.ravel() + rng.random(n * n)) / n
                root = np.sqrt(a)  # uniform in the triangle
                w0, w1, w2 = 1 - root, root * (1 - b), root * b
                c = corners[t]
                uv = w0[:, None] * c[0] + w1[:, None] * c[1] + w2[:, None] * c[2]
                result[t] = self.sample(uv).mean(axis=0)
        return result
