// The reflectance of base/reflectance/brdf.h, over the maps as textures.

struct Texel {
  vec3 normal;    // tangent frame
  vec3 diffuse;   // weighted by 1 - F0 where the convention says so
  vec3 specular;  // F0
  float roughness;
};

uniform sampler2D diffuseMap;       // sRGB, decoded by the texture unit
uniform sampler2D specularMap;      // likewise
uniform sampler2D geometryHighMap;  // normal x, normal y, roughness: high bytes …
uniform sampler2D geometryLowMap;   // … and low bytes of 16 bits
uniform bool diffuseWhole;
uniform vec2 lobeShares;  // of the wide and the narrow specular lobe …
uniform vec2 lobeScales;  // … and what multiplies roughness in them
uniform float lobeTail;   // exponent γ of the lobes' tails; 2: GGX
uniform float lobeAnisotropy;  // ratio of α along lobeDirection to α across; 1: none
uniform vec2 lobeDirection;    // unit, in the tangent frame
uniform float coatF0;     // of a narrow lobe that is a coat's; 0: it has the map's

Texel texelAt(vec2 uv) {
  Texel t;
  vec3 g = (texture(geometryHighMap, uv).rgb * 65280.0 + texture(geometryLowMap, uv).rgb * 255.0)
           / 65535.0;
  vec2 xy = 2.0 * g.xy - 1.0;
  t.normal = normalize(vec3(xy, sqrt(max(1e-6, 1.0 - dot(xy, xy)))));
  t.roughness = max(g.z, 0.02);
  t.specular = texture(specularMap, uv).rgb;
  t.diffuse = texture(diffuseMap, uv).rgb;
  if (!diffuseWhole) t.diffuse *= 1.0 - t.specular;
  return t;
}

// sin² between n and h, of anisotropic lobes stretched: what h has along g counts less, what it has
// across more. g: in the surface, the direction in which lobes are wider.
float stretchedSine(vec3 n, vec3 h, vec3 g) {
  vec3 across = n - dot(n, h) * h;
  float sine = dot(across, across);
  if (lobeAnisotropy == 1.0) return sine;
  float noG = dot(n, g), along = dot(h, g) - dot(n, h) * noG;
  return lobeAnisotropy * sine
         + (1.0 / lobeAnisotropy - lobeAnisotropy) * along * along / max(1.0 - noG * noG, 1e-3);
}

// D·G/(4·NoL·NoV) of one lobe, `sine`: stretchedSine; D is Student's t, GGX where γ = 2.
float specularLobe(float roughness, vec3 n, vec3 h, float sine, float noL, float noV) {
  float alpha = roughness * roughness;
  float noH = max(dot(n, h), 0.0);
  float wide = alpha * sqrt(lobeTail - 1.0);
  // noH²((γ − 1)α² − 1) + 1, without cancellation near the peak.
  float denominator = max(noH > 0.0 ? sine + noH * noH * wide * wide : 1.0, 1e-8);
  float ratio = wide / denominator;
  float tail = (lobeTail - 1.0) * pow(noH * noH * wide * wide / denominator, lobeTail - 2.0);
  float k = 0.5 * alpha;
  float masking = (noL * (1.0 - k) + k) * (noV * (1.0 - k) + k);
  return (lobeTail > 2.0 ? tail : 1.0) * ratio * ratio / (4.0 * 3.14159265358979 * masking);
}

float lobeRoughness(Texel t, int lobe) { return min(t.roughness * lobeScales[lobe], 1.0); }

vec3 lobeF0(Texel t, int lobe) { return lobe == 1 && coatF0 > 0.0 ? vec3(coatF0) : t.specular; }

// f of unit directions n, l, v; g: stretchedSine's.
vec3 brdf(Texel t, vec3 n, vec3 l, vec3 v, vec3 g) {
  vec3 h = normalize(l + v);
  float noL = max(dot(n, l), 1e-8), noV = max(dot(n, v), 1e-8), voH = max(dot(v, h), 1e-8);
  float rim = exp2(voH * (-5.55473 * voH - 6.98316));
  vec3 f = t.diffuse / 3.14159265358979;
  float sine = stretchedSine(n, h, g);
  for (int i = 0; i < 2; ++i) {
    if (lobeShares[i] == 0.0) continue;
    vec3 f0 = lobeF0(t, i);
    f += lobeShares[i] * specularLobe(lobeRoughness(t, i), n, h, sine, noL, noV) * (f0 + (1.0 - f0) * rim);
  }
  return f;
}
