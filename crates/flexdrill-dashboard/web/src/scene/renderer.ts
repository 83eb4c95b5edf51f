// WebGL2 behind the scene: one program, meshes in one colour each.

import type { Mesh } from "./mesh";

const VERTEX = `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 matrix;
uniform vec3 eye;
out vec3 vNormal;
out vec3 vView;
void main() {
  vNormal = normal;
  vView = eye - position;
  gl_Position = matrix * vec4(position, 1.0);
}`;

const FRAGMENT = `#version 300 es
precision mediump float;
in vec3 vNormal;
in vec3 vView;
uniform vec4 colour;
uniform float rim;
out vec4 result;
void main() {
  vec3 n = normalize(vNormal);
  vec3 v = normalize(vView);
  float facing = abs(dot(n, v));
  float light = 0.55 + 0.35 * facing + 0.1 * -n.z;
  float alpha = colour.a + rim * pow(1.0 - facing, 3.0);
  result = vec4(colour.rgb * light * alpha, alpha);
}`;

/** Which faces of closed tubes are drawn; those of ours wind so that WebGL takes the far ones for its front. */
export type Faces = "all" | "back" | "front";

export class Renderer {
  readonly gl: WebGL2RenderingContext;
  /** The processor draws: every point of the picture costs. */
  readonly bySoftware = drawnBySoftware();
  private readonly program: WebGLProgram;
  private readonly uniforms: Record<"matrix" | "eye" | "colour" | "rim", WebGLUniformLocation | null>;
  private readonly buffers = new Map<
    Mesh,
    {
      array: WebGLVertexArrayObject;
      vertices: WebGLBuffer;
      indices: WebGLBuffer;
      vertexBytes: number;
      indexBytes: number;
    }
  >();

  /** Throws when the browser has no WebGL2. */
  constructor(canvas: HTMLCanvasElement) {
    const gl = canvas.getContext("webgl2", {
      antialias: !this.bySoftware,
      alpha: false,
      powerPreference: "low-power",
    });
    if (!gl) throw new Error("this browser has no WebGL2");
    this.gl = gl;
    this.program = link(gl);
    const at = (name: string) => gl.getUniformLocation(this.program, name);
    this.uniforms = { matrix: at("matrix"), eye: at("eye"), colour: at("colour"), rim: at("rim") };
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  begin(matrix: Float32Array, eye: ArrayLike<number>, ground: readonly [number, number, number]): void {
    const { gl } = this;
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.clearColor(...ground, 1);
    gl.depthMask(true);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.program);
    gl.uniformMatrix4fv(this.uniforms.matrix, false, matrix);
    gl.uniform3f(this.uniforms.eye, eye[0], eye[1], eye[2]);
  }

  /** Takes a mesh's triangles to the graphics memory; needed after each change. */
  upload(mesh: Mesh): void {
    const { gl } = this;
    let entry = this.buffers.get(mesh);
    if (!entry) {
      const array = gl.createVertexArray();
      const vertices = gl.createBuffer();
      const indices = gl.createBuffer();
      if (!array || !vertices || !indices) return;
      entry = { array, vertices, indices, vertexBytes: 0, indexBytes: 0 };
      this.buffers.set(mesh, entry);
      gl.bindVertexArray(array);
      gl.bindBuffer(gl.ARRAY_BUFFER, vertices);
      gl.enableVertexAttribArray(0);
      gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 24, 0);
      gl.enableVertexAttribArray(1);
      gl.vertexAttribPointer(1, 3, gl.FLOAT, false, 24, 12);
    }
    gl.bindVertexArray(entry.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, entry.vertices);
    if (entry.vertexBytes < mesh.vertices.byteLength) {
      gl.bufferData(gl.ARRAY_BUFFER, mesh.vertices.byteLength, gl.DYNAMIC_DRAW);
      entry.vertexBytes = mesh.vertices.byteLength;
    }
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, mesh.vertices, 0, 6 * mesh.vertexCount);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, entry.indices);
    if (entry.indexBytes < mesh.indices.byteLength) {
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, mesh.indices.byteLength, gl.DYNAMIC_DRAW);
      entry.indexBytes = mesh.indices.byteLength;
    }
    gl.bufferSubData(gl.ELEMENT_ARRAY_BUFFER, 0, mesh.indices, 0, mesh.indexCount);
  }

  /** Draws a mesh in one colour; a translucent one leaves the depth as it is. `rim` makes edges less translucent. */
  draw(mesh: Mesh, colour: readonly [number, number, number], alpha: number, faces: Faces = "all", rim = 0): void {
    const { gl } = this;
    const entry = this.buffers.get(mesh);
    if (!entry || mesh.indexCount === 0) return;
    gl.uniform4f(this.uniforms.colour, ...colour, alpha);
    gl.uniform1f(this.uniforms.rim, rim);
    gl.depthMask(alpha >= 1);
    if (faces === "all") gl.disable(gl.CULL_FACE);
    else {
      gl.enable(gl.CULL_FACE);
      gl.cullFace(faces === "back" ? gl.BACK : gl.FRONT);
    }
    gl.bindVertexArray(entry.array);
    gl.drawElements(gl.TRIANGLES, mesh.indexCount, gl.UNSIGNED_INT, 0);
  }
}

/** Whether pictures are drawn by the processor: smoothing of edges then costs as much as all the rest. */
function drawnBySoftware(): boolean {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) return false;
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

function link(gl: WebGL2RenderingContext): WebGLProgram {
  const program = gl.createProgram();
  for (const [kind, source] of [
    [gl.VERTEX_SHADER, VERTEX],
    [gl.FRAGMENT_SHADER, FRAGMENT],
  ] as const) {
    const shader = gl.createShader(kind);
    if (!shader) throw new Error("no shader");
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
    throw new Error(`shaders: ${gl.getProgramInfoLog(program) ?? "do not link"}`);
  }
  return program;
}
