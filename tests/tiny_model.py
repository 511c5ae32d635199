"""Language models of half a megabyte, and eyes for them, made in a moment for a real llama.cpp.

Nobody has trained them. The layers are random numbers; on top of those, the output matrix holds
habits: which character tends to follow which. A JSON schema does the rest, since llama.cpp lets
through only what its grammar allows. What such a model says depends on the seed, not on the words
it is asked: it proves that Deck and a server understand each other, and nothing about thinking.

The format is that of GGUF version 3, architecture `llama`; the tokens are bytes, as in GPT-2.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import gguf
import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import NDArray

END = "<|im_end|>"
CALL, CALLED = "<tool_call>", "</tool_call>"
WORDS = ("<|endoftext|>", "<|im_start|>", END, CALL, CALLED)
"""Tokens beside the 256 bytes."""
READABLE = "\n" + "".join(map(chr, range(32, 127)))

LAYERS, HEADS, WIDTH, HIDDEN = 2, 4, 128, 128
TRAINED_CONTEXT = 4096
"""How many tokens the file says that the model was trained for."""
PICTURE, PATCH, EYE_WIDTH = 112, 14, 32
"""Side of a picture and of the squares it is cut into, in pixels."""
NEVER = -40.0
"""Added to the logit of a token that is not to be said."""

TEMPLATE = """\
{%- if tools %}<|im_start|>system
{%- if messages[0].role == 'system' %}
{{ messages[0].content }}
{%- endif %}
<tools>
{%- for tool in tools %}
{{ tool | tojson }}
{%- endfor %}
</tools>
<tool_call>
{"name": <function-name>, "arguments": <args-json-object>}
</tool_call><|im_end|>
{% endif %}
{%- for message in messages %}
{%- if message.role == 'assistant' and message.tool_calls %}<|im_start|>assistant
{{- '\\n' + message.content if message.content else '' }}
{%- for call in message.tool_calls %}
<tool_call>
{"name": "{{ call.function.name }}", "arguments": {{ call.function.arguments | tojson }}}
</tool_call>
{%- endfor %}<|im_end|>
{% elif message.role == 'tool' %}<|im_start|>user
<tool_response>
{{ message.content }}
</tool_response><|im_end|>
{% elif not (tools and message.role == 'system' and loop.first) %}<|im_start|>{{ message.role }}
{{ message.content }}<|im_end|>
{% endif %}
{%- endfor %}
{%- if add_generation_prompt %}<|im_start|>assistant
{% endif %}"""
"""How a conversation is written down: ChatML, with tool calls as Qwen and Hermes have them."""


@dataclass(frozen=True)
class Habits:
    """What a model tends to say, in logits added to the noise of its random weights."""

    after: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    """By what was said last: what comes next."""
    always: Mapping[str, float] = field(default_factory=dict)
    """Whatever was said last."""
    noise: float = 0.3
    """Standard deviation of the random output weights."""
    readable: bool = True
    """Says only ASCII; else also bytes that are not UTF-8."""


def _driving(numbers: Mapping[str, Mapping[str, float]]) -> Habits:
    """Return habits that make one drive command, sometimes a few, with these numbers."""
    return Habits(
        after={
            "\n": {CALL: 14, CALLED: 10, "{": 12, END: 15},
            "{": {'"': 12},
            '"': {"o": 12, "d": 8, ":": 8},
            "o": {"k": 14},
            "k": {'"': 14},
            "d": {'"': 10},
            ":": {"0": 14, '"': 12, "[": 12, "{": 12},
            "[": {"{": 12},
            ",": {'"': 12, "{": 12},
            "}": {"]": 13, END: 10, "}": 10, ",": 10, "\n": 9},
            "]": {"}": 12, END: 10},
            CALL: {"\n": 14},
            CALLED: {END: 14},
            **numbers,
        },
        noise=0.05,
    )


_NEXT_FIELD = {",": 12.0, "}": 12.0, '"': 8.0}
DRIVES = _driving({"0": {".": 14}, ".": dict.fromkeys("1234", 12), **dict.fromkeys("1234", _NEXT_FIELD)})
"""Says `ok` and drives: forward and to the left, at 0.1 to 0.4 m/s; calls a tool if it has one."""
SPEEDS = _driving({"0": {"9": 14}, ":": {"9": 14, '"': 12, "[": 12, "{": 12}, "9": _NEXT_FIELD})
"""Drives at 9 m/s, which the grammar lets through: llama.cpp keeps no range of a `number`."""
GARBLES = replace(
    SPEEDS, after={**SPEEDS.after, '"': {**SPEEDS.after['"'], "\xc3": 15}}, always={'"': 3}, readable=False
)
"""Likewise at 9 m/s, with bytes that are not UTF-8: llama.cpp breaks off some of such answers."""
RAMBLES = Habits(
    after={"[": {"{": 7}, "}": {"]": 6}},
    always={'"': 6, "}": 6, "]": 6, ",": 4, END: 8, **dict.fromkeys("0123456789", 2.0)},
)
"""Says anything that the schema allows, numbers out of range too, and comes to an end."""


_EYES: dict[str, tuple[int, ...]] = {
    "v.patch_embd.weight": (EYE_WIDTH, 3, PATCH, PATCH),
    "v.patch_embd.bias": (EYE_WIDTH,),
    "v.position_embd.weight": ((PICTURE // PATCH) ** 2, EYE_WIDTH),
    **{
        f"v.blk.0.{name}.{kind}": (EYE_WIDTH, EYE_WIDTH)[: 1 + (kind == "weight")]
        for name in ("attn_q", "attn_k", "attn_v", "attn_out")
        for kind in ("weight", "bias")
    },
    **{
        f"{name}.{kind}": (EYE_WIDTH,)
        for name in ("v.blk.0.ln1", "v.blk.0.ln2", "v.post_ln")
        for kind in ("weight", "bias")
    },
    "v.blk.0.ffn_up.weight": (2 * EYE_WIDTH, EYE_WIDTH),
    "v.blk.0.ffn_up.bias": (2 * EYE_WIDTH,),
    "v.blk.0.ffn_down.weight": (EYE_WIDTH, 2 * EYE_WIDTH),
    "v.blk.0.ffn_down.bias": (EYE_WIDTH,),
    "mm.input_projection.weight": (EYE_WIDTH, WIDTH),
    "mm.soft_emb_norm.weight": (EYE_WIDTH,),
}
"""The shapes of its weights; what has one dimension is a norm or a bias, and all ones."""


def write_model(path: Path, habits: Habits = DRIVES, *, seed: int = 0) -> Path:
    """Write a model with these habits; return its path."""
    random = np.random.default_rng(seed)
    tokens = [*_letters_of_bytes(), *WORDS]
    writer = gguf.GGUFWriter(str(path), "llama")
    _describe(writer, tokens)
    embedding = _embedding(random, len(tokens))
    half = np.float16
    writer.add_tensor("token_embd.weight", embedding.astype(half))
    writer.add_tensor("output_norm.weight", np.ones(WIDTH, np.float32))
    writer.add_tensor("output.weight", _output(random, habits, len(tokens)).astype(half))
    for number in range(LAYERS):
        for name, weights in _layer(random).items():
            writer.add_tensor(f"blk.{number}.{name}.weight", weights)
    writer.write_header_to_file()
    writer.write_kv_data_to_file()
    writer.write_tensors_to_file()
    writer.close()
    return path


def write_eyes(path: Path, *, seed: int = 0) -> Path:
    """Write what turns pictures into four tokens for such a model; return its path.

    The architecture is that of Gemma 3, of random weights as well: what it makes of a picture has
    nothing to do with what is in it.
    """
    random = np.random.default_rng(seed)
    writer = gguf.GGUFWriter(str(path), "clip")
    writer.add_type("mmproj")
    writer.add_clip_has_vision_encoder(True)
    writer.add_clip_vision_projector_type(gguf.VisionProjectorType.GEMMA3)
    writer.add_vision_use_gelu(True)
    writer.add_vision_image_size(PICTURE)
    writer.add_vision_patch_size(PATCH)
    writer.add_vision_embedding_length(EYE_WIDTH)
    writer.add_vision_feed_forward_length(2 * EYE_WIDTH)
    writer.add_vision_projection_dim(WIDTH)
    writer.add_vision_block_count(1)
    writer.add_vision_head_count(2)
    writer.add_vision_attention_layernorm_eps(1e-6)
    writer.add_vision_image_mean([0.5] * 3)
    writer.add_vision_image_std([0.5] * 3)
    for name, shape in _EYES.items():
        values = random.normal(0, 0.1, shape) if shape[1:] else np.ones(shape)
        writer.add_tensor(name, values.astype(np.float32))
    writer.write_header_to_file()
    writer.write_kv_data_to_file()
    writer.write_tensors_to_file()
    writer.close()
    return path


def _describe(writer: gguf.GGUFWriter, tokens: list[str]) -> None:
    """Add what llama.cpp has to know of the layers, the tokens and the conversation."""
    writer.add_name("tiny model of Deck's tests")
    writer.add_context_length(TRAINED_CONTEXT)
    writer.add_embedding_length(WIDTH)
    writer.add_block_count(LAYERS)
    writer.add_feed_forward_length(HIDDEN)
    writer.add_head_count(HEADS)
    writer.add_head_count_kv(HEADS)
    writer.add_layer_norm_rms_eps(1e-5)
    writer.add_rope_dimension_count(WIDTH // HEADS)
    writer.add_vocab_size(len(tokens))
    writer.add_file_type(gguf.LlamaFileType.MOSTLY_F16)
    writer.add_tokenizer_model("gpt2")
    writer.add_tokenizer_pre("default")
    writer.add_token_list(tokens)
    kinds = [gguf.TokenType.NORMAL] * 256
    kinds += [gguf.TokenType.CONTROL] * 3 + [gguf.TokenType.USER_DEFINED] * 2
    writer.add_token_types(kinds)
    # It must have one, and this one never applies: its product is not a token.
    writer.add_token_merges(["Ā ā"])
    writer.add_bos_token_id(256)
    writer.add_eos_token_id(258)
    writer.add_add_bos_token(False)
    writer.add_chat_template(TEMPLATE)


def _letters_of_bytes() -> list[str]:
    """Return the 256 letters by which GPT-2 writes bytes: those that can be seen stay."""
    seen = {*range(33, 127), *range(161, 173), *range(174, 256)}
    hidden = [byte for byte in range(256) if byte not in seen]
    stand_in = {byte: chr(256 + number) for number, byte in enumerate(hidden)}
    return [stand_in.get(byte, chr(byte)) for byte in range(256)]


def _token(text: str) -> int:
    return 256 + WORDS.index(text) if text in WORDS else ord(text)


_OWN = (*READABLE, CALL, CALLED)
"""What has a dimension of its own, so that what follows it can be set; 0 is 1 for all of them."""


def _dimension(text: str) -> int:
    return 1 + _OWN.index(text)


def _embedding(random: np.random.Generator, tokens: int) -> NDArray[np.float64]:
    embedding = np.zeros((tokens, WIDTH))
    rest = 1 + len(_OWN)
    embedding[:, rest:] = random.normal(0, 0.3, (tokens, WIDTH - rest))
    embedding[:, 0] = 1
    for text in _OWN:
        embedding[_token(text), _dimension(text)] = 1
    return embedding


def _output(random: np.random.Generator, habits: Habits, tokens: int) -> NDArray[np.float64]:
    # The last layer is normalized to a root mean square of 1, and has two ones in it.
    one = np.sqrt(WIDTH / 2)
    output = random.normal(0, habits.noise, (tokens, WIDTH))
    for text, logit in habits.always.items():
        output[_token(text), 0] += logit / one
    for last, following in habits.after.items():
        for text, logit in following.items():
            output[_token(text), _dimension(last)] += logit / one
    if habits.readable:
        sayable = {_token(text) for text in (*_OWN, END)}
        output[[token for token in range(tokens) if token not in sayable], 0] += NEVER / one
    return output


def _layer(random: np.random.Generator) -> dict[str, NDArray[np.floating]]:
    """Return a layer that computes something, and adds little of it to what it was given."""

    def weights(rows: int, columns: int, scale: float) -> NDArray[np.floating]:
        return random.normal(0, scale / np.sqrt(columns), (rows, columns)).astype(np.float16)

    return {
        "attn_norm": np.ones(WIDTH, np.float32),
        "attn_q": weights(WIDTH, WIDTH, 1),
        "attn_k": weights(WIDTH, WIDTH, 1),
        "attn_v": weights(WIDTH, WIDTH, 1),
        "attn_output": weights(WIDTH, WIDTH, 0.05),
        "ffn_norm": np.ones(WIDTH, np.float32),
        "ffn_gate": weights(HIDDEN, WIDTH, 1),
        "ffn_up": weights(HIDDEN, WIDTH, 1),
        "ffn_down": weights(WIDTH, HIDDEN, 0.05),
    }
