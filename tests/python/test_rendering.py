"""The renderer, its gradients and the BRDF."""

import numpy as np
import pytest

import glint

CAMERA_MM = (20, -30, 250)
LIGHT_MM = (-60, 40, 300)
LIGHT_RGB = (2e5, 3e5, 2.5e5)
AMBIENT_RGB = (0.1, 0.2, 0.05)
EXPOSURE = 1.5
CONVENTIONS = ("photograph", "dir2019", "materialgan")


def model(planes, maps):
    """The radiance by docs/conventions.md in double precision, H x W x 3."""
    planes = np.asarray(planes, dtype=float)
    normal, diffuse, specular = (np.moveaxis(planes[i:i + 3], 0, -1) for i in (0, 3, 6))
    x, y = maps.texel_centres_mm()
    texel = np.stack([*np.meshgrid(x, y), np.zeros(maps.shape)], axis=-1)
    to_light, to_camera = LIGHT_MM - texel, CAMERA_MM - texel
    distance = np.linalg.norm(to_light, axis=-1, keepdims=True)
    weight = "one_minus_specular" if "one_minus_specular" in maps.convention else "one"
    irradiance = np.array(LIGHT_RGB) / (1 if "light=none" in maps.convention else distance**2)
    cosine = np.maximum(np.sum(normal * to_light, axis=-1, keepdims=True) / distance, 1e-8)
    reflected = glint.brdf(to_light, to_camera, normal, diffuse, specular, planes[9],
                           diffuse_weight=weight)
    share = 1 if weight == "one" else 1 - specular
    around = np.array(AMBIENT_RGB) * (share * diffuse + specular) / np.pi
    return EXPOSURE * (irradiance * reflected * cosine + around)


def rendered(maps):
    return glint.render(maps, CAMERA_MM, LIGHT_MM, LIGHT_RGB, ambient_rgb=AMBIENT_RGB,
                        exposure=EXPOSURE)


def gradients(maps, radiance_gradient):
    return glint.render_gradients(maps, radiance_gradient, CAMERA_MM, LIGHT_MM, LIGHT_RGB,
                                  ambient_rgb=AMBIENT_RGB, exposure=EXPOSURE)


def with_convention(maps, convention):
    return glint.Maps.from_planes(maps.planes, size_mm=maps.size_mm, convention=convention)


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_renderings_are_the_model(random_maps, convention):
    maps = with_convention(random_maps, convention)
    np.testing.assert_allclose(rendered(maps), model(maps.planes, maps), rtol=5e-6)


def test_brdf_is_the_formula_and_reciprocal():
    light, camera, normal = np.array([0.3, 0.1, 0.9]), np.array([-0.4, 0.2, 1.0]), (0, 0, 1)
    f = glint.brdf(light, camera, normal, 0.5, 0.04, 0.6)
    l, v = light / np.linalg.norm(light), camera / np.linalg.norm(camera)
    h = (l + v) / np.linalg.norm(l + v)
    alpha, k = 0.36, 0.18
    d = (alpha / (h[2]**2 * (alpha**2 - 1) + 1))**2 / np.pi
    g = np.prod([x / (x * (1 - k) + k) for x in (l[2], v[2])])
    fresnel = 0.04 + 0.96 * 2**(v @ h * (-5.55473 * (v @ h) - 6.98316))
    np.testing.assert_allclose(f, 0.5 / np.pi + d * g * fresnel / (4 * l[2] * v[2]), rtol=1e-12)
    np.testing.assert_allclose(glint.brdf(camera, light, normal, 0.5, 0.04, 0.6), f, rtol=1e-12)


def test_tails_fall_off_as_students_distribution_of_slopes():
    light = np.array((0.5, -0.1, 1.0))
    camera = np.array((0.1, 0.3, 1.0))
    l, v = (x / np.linalg.norm(x) for x in (light, camera))
    h = (l + v) / np.linalg.norm(l + v)
    alpha, tangent2 = 0.36, 1 / h[2]**2 - 1

    def distribution(tail):
        return ((tail - 1)**tail * alpha**(2 * tail - 2)
                / (np.pi * h[2]**4 * ((tail - 1) * alpha**2 + tangent2)**tail))

    def f(tail):
        return glint.brdf(light, camera, (0, 0, 1), 0.0, 0.04, 0.6, tail=tail)

    for tail in (3, 4, 8):
        np.testing.assert_allclose(f(tail) / f(2), distribution(tail) / distribution(2), rtol=1e-12)
    with pytest.raises(ValueError, match="tail"):
        f(1)


def test_a_coat_reflects_white_by_its_own_f0():
    light, camera = (0.3, 0.2, 1), (-0.3, -0.2, 1)

    def f(specular, lobe):
        return glint.brdf(light, camera, (0, 0, 1), 0.0, specular, 0.4, narrow_lobe=lobe)

    coat = f((0.2, 0.1, 0.0), (0.5, 0.4, 0.04)) - f((0.2, 0.1, 0.0), (0.5, 0.4, 1e-12))
    assert coat[0] > 0
    np.testing.assert_allclose(coat, coat[0], rtol=1e-9)
    np.testing.assert_allclose(f(0.04, (0.5, 0.4, 0.04)), f(0.04, (0.5, 0.4)), rtol=1e-12)
    with pytest.raises(ValueError, match="narrow_lobe"):
        f(0.04, (0.5, 0.4, 2.0))


def test_brdf_broadcasts():
    f = glint.brdf(np.ones((5, 1, 3)), (0, 0, 1), (0, 0, 1), 0.5, (0.04, 0.05, 0.06),
                   np.linspace(0.1, 1, 7))
    assert f.shape == (5, 7, 3)
    assert np.array_equal(f[0], f[4])
    one = glint.brdf((1, 1, 1), (0, 0, 1), (0, 0, 1), 0.5, (0.04, 0.05, 0.06), 1.0)
    assert np.array_equal(f[2, 6], one)


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_gradients_agree_with_finite_differences(random_maps, convention):
    """Every texel's derivative, by central differences of the model in double precision."""
    maps = with_convention(random_maps, convention)
    weights = np.random.default_rng(4).uniform(-1, 1, (*maps.shape, 3))
    gradient = gradients(maps, weights)
    step = 1e-6
    for plane in range(3, 10):
        plus, minus = maps.planes.astype(float), maps.planes.astype(float)
        plus[plane] += step
        minus[plane] -= step
        slope = np.sum(weights * (model(plus, maps) - model(minus, maps)), axis=-1) / (2 * step)
        scale = np.max(np.abs(slope))
        np.testing.assert_allclose(gradient.planes[plane], slope, rtol=1e-4, atol=2e-6 * scale,
                                   err_msg=glint.CHANNELS[plane])


def test_gradients_of_normals_agree_with_finite_differences(random_maps):
    """Along both tangents of every normal, which stays unit."""
    maps = random_maps
    weights = np.random.default_rng(5).uniform(-1, 1, (*maps.shape, 3))
    tangents = glint.tangent(maps, gradients(maps, weights))
    normal = maps.normal.astype(float)
    step = 1e-6
    for axis in ((1, 0, 0), (0, 1, 0)):
        along = np.cross(normal, axis)
        slopes = []
        for sign in (1, -1):
            moved = normal + sign * step * along
            moved /= np.linalg.norm(moved, axis=-1, keepdims=True)
            planes = maps.planes.astype(float)
            planes[0:3] = np.moveaxis(moved, -1, 0)
            slopes.append(np.sum(weights * model(planes, maps), axis=-1))
        slope = (slopes[0] - slopes[1]) / (2 * step)
        scale = np.max(np.abs(slope))
        np.testing.assert_allclose(np.sum(tangents * along, axis=-1), slope, rtol=1e-4,
                                   atol=2e-6 * scale)


def test_gradients_agree_with_differences_of_renderings(random_maps):
    """<weights, J d> = <J' weights, d> for a random direction d of all maps but the normals."""
    random = np.random.default_rng(6)
    weights = random.uniform(-1, 1, (*random_maps.shape, 3))
    direction = random.uniform(-1e-3, 1e-3, random_maps.planes.shape)
    direction[0:3] = 0
    images = [rendered(glint.Maps.from_planes(random_maps.planes + sign * direction,
                                              size_mm=random_maps.size_mm)).astype(float)
              for sign in (1, -1)]
    expected = np.sum(weights * (images[0] - images[1])) / 2
    actual = np.sum(gradients(random_maps, weights).planes * direction)
    assert actual == pytest.approx(expected, rel=5e-3)


def test_threads_do_not_change_a_bit(random_maps):
    one = glint.render(random_maps, CAMERA_MM, LIGHT_MM, threads=1)
    assert np.array_equal(one, glint.render(random_maps, CAMERA_MM, LIGHT_MM, threads=3))


def test_true_maps_render_as_the_views_show(capture, truth):
    for name in capture.views:
        view = capture.view(name)
        np.testing.assert_allclose(view.render(truth), view.radiance, rtol=1e-5, atol=1e-7)


def test_the_default_light_makes_white_paper_white():
    paper = glint.Maps((0, 0, 1), 1.0, 1.0, 0.0, size_mm=1, shape=(1, 1))
    image = glint.render(paper, (0, 0, 300), (0, 0, 200))
    np.testing.assert_allclose(image, 1, rtol=0.06)  # and Fresnel's part of a rough surface


def test_descending_the_gradient_recovers_the_maps(random_maps):
    """A loop of one's own: albedo and roughness from one rendering, by gradient descent."""
    target = rendered(random_maps)
    start = random_maps.copy()
    start.diffuse[...] = 0.4
    losses = []
    for _ in range(60):
        residual = rendered(start) - target
        losses.append(float(np.mean(residual**2)))
        gradient = gradients(start, residual)
        start.diffuse[...] = np.clip(start.diffuse - 0.1 * gradient.diffuse, 0, 1)
    assert losses[-1] < 1e-3 * losses[0]


def test_what_does_not_fit_is_told(random_maps):
    with pytest.raises(ValueError, match=r"light_mm: found z = -1"):
        glint.render(random_maps, CAMERA_MM, (0, 0, -1))
    with pytest.raises(ValueError, match="camera_mm.*three finite numbers"):
        glint.render(random_maps, (0, 0), LIGHT_MM)
    with pytest.raises(ValueError, match=r"radiance_gradient.*the maps need \(12, 17, 3\)"):
        gradients(random_maps, np.zeros((12, 16, 3)))
    with pytest.raises(ValueError, match="not of length 1"):
        glint.Maps((0, 0, 2), 0.5, 0.5, 0.04, size_mm=10, shape=(2, 2))
    with pytest.raises(ValueError, match="diffuse: found an array of shape"):
        glint.Maps(np.broadcast_to((0, 0, 1), (4, 4, 3)), np.ones((5, 4, 3)), 0.5, 0.04, size_mm=10)
    with pytest.raises(ValueError, match="size_mm"):
        glint.Maps((0, 0, 1), 0.5, 0.5, 0.04, size_mm=0, shape=(2, 2))
    with pytest.raises(ValueError, match="photo"):
        glint.Maps((0, 0, 1), 0.5, 0.5, 0.04, size_mm=1, shape=(2, 2), convention="phong")


def test_anisotropic_lobes_are_wider_along_their_direction():
    def f(azimuth_deg, anisotropy=(2.25, 30.0)):
        azimuth = np.radians(azimuth_deg)
        light = (0.5 * np.cos(azimuth), 0.5 * np.sin(azimuth), 1)
        return glint.brdf(light, (0, 0, 1), (0, 0, 1), 0.0, 0.04, 0.4, anisotropy=anisotropy)[0]

    assert f(30) > 1.5 * f(75) > 2 * f(120)
    np.testing.assert_allclose(f(30), f(210), rtol=1e-12)
    np.testing.assert_allclose(f(10, (1.0, 0.0)), f(100, (1.0, 77.0)), rtol=1e-12)
    with pytest.raises(ValueError, match="anisotropy"):
        f(0, (0.5, 0.0))
